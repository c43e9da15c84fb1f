"""Libraries of the extra `io`, imported when they are used."""

from __future__ import annotations

import importlib
from types import ModuleType


def _need(name: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(
            f"{name} is needed for this and is not installed: pip install 'ropedyn[io]'"
        ) from error


def pandas() -> ModuleType:
    """Import pandas."""
    return _need("pandas")


def xarray() -> ModuleType:
    """Import xarray."""
    return _need("xarray")


def h5netcdf() -> ModuleType:
    """Import what reads and writes netCDF."""
    return _need("h5netcdf")


def netcdf() -> ModuleType:
    """Import xarray and make sure of what it reads and writes netCDF with."""
    _need("h5py")  # first: h5netcdf imports it
    h5netcdf()
    return xarray()


def pyuff() -> ModuleType:
    """Import pyuff."""
    return _need("pyuff")
