"""What every answer can do: table, data frame, xarray, netCDF file."""

from __future__ import annotations

import hashlib
import io
import json
import os
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import Field, dataclass, fields, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from . import check, extra
from .atomic import write_bytes
from .computed import Lazy, paid_for
from .drawing import draw
from .errors import SceneError, SolveError
from .reading import reading
from .table import Table

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes


KIND = "ropedyn"  # Attribute of a file that says which answer it holds.
PREFIX = "ropedyn_"
"""Attributes that hold fields begin so: netCDF gives some names, as "coordinates", a meaning."""
ABSENT = "ropedyn absent"  # Attribute that says which parts could not be computed, and why.
SEAL = b"ropedyn sha256 "  # This and a checksum end a file.


@dataclass(frozen=True)
class Cost:
    """What an answer cost.

    Attributes
    ----------
    method : str
        The solver.
    elements, unknowns : int
        Of the chain, and of what was solved of it: the coordinates of its nodes that can move, of
        continuous spans those of stations. One span between ends that cannot move has 0: what
        moves is inside it, and exact.
    sweeps : int
        Walks from one end of the rope to the other, at one frequency each; of steps through time,
        their stages.
    factorisations : int
        Of matrices: of the solvers that have some.
    redone : float
        Share of the answer that was solved twice: modes that counts did not confirm at first.
        0 of responses: one sweep is careful enough for all of them.
    seconds : float
        What a caller has waited: from the question, checks included, to its answer, and for what
        has been computed since because it was read, as `mesh_error`, shapes and tables.

    Examples
    --------
    >>> import ropedyn as rd
    >>> model = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile(elements=8)
    >>> cost = model.modes(2).cost
    >>> cost.method, cost.elements, cost.unknowns
    ('sweep', 8, 7)
    """

    method: str
    elements: int
    unknowns: int
    sweeps: int = 0
    factorisations: int = 0
    redone: float = 0.0
    seconds: float = 0.0


class Work(NamedTuple):
    """What was done for an answer, see `Cost`."""

    sweeps: int = 0
    factorisations: int = 0
    redone: int = 0  # How many of its numbers were solved twice

    @classmethod
    def of(cls, parts: Iterable[Work]) -> Work:
        """Return what several parts took together."""
        return cls(*map(sum, zip(cls(), *parts)))


def axes(*names: str, unit: str = "", keyed: bool = False) -> dict[str, Any]:
    """Return the metadata of an array field: its axes and its unit.

    With `keyed` the field is a dictionary of such arrays.
    """
    return {"axes": names, "unit": unit, "keyed": keyed}


def freeze(thing: Any) -> None:
    """Make the arrays that something holds read-only; a pickle or a copy forgets that."""
    for value in vars(thing).values():
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
        elif isinstance(value, (tuple, list, dict)):
            for array in value.values() if isinstance(value, dict) else value:
                if isinstance(array, np.ndarray):
                    array.setflags(write=False)


TRANSIENT = {"transient": True}  # Metadata of a field that no file keeps: it has a default.


def kept_as(sheet: Callable[[Any], Any], read: Callable[[Any], Any]) -> dict[str, Any]:
    """Return the metadata of a field that a file keeps as what JSON knows."""
    return {"sheet": sheet, "read": read}


class Frozen:
    """Base of dataclasses whose arrays are read-only: made, unpickled or copied."""

    def __post_init__(self) -> None:
        freeze(self)

    def __getstate__(self) -> dict[str, Any]:
        """Return a copy of what is kept: a thread may compute more while it is pickled."""
        return dict(vars(self))

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        freeze(self)


class Answer(Frozen):
    """Base of the answers: frozen dataclasses whose array fields are declared with `axes`.

    Examples
    --------
    >>> import ropedyn as rd
    >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(2)
    >>> isinstance(modes, rd.Answer)
    True
    >>> print(str(modes).splitlines()[0])
    natural frequencies
    """

    kinds: ClassVar[dict[str, type[Answer]]] = {}
    said: ClassVar[tuple[str, ...]] = ()  # What a report tells beside table and plain fields.

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        Answer.kinds[cls.__name__] = cls
        # a dataclass writes one of its own where the class has none
        if "__repr__" not in vars(cls):
            cls.__repr__ = Answer.__repr__  # type: ignore[method-assign]
        if "table" in vars(cls):
            cls.table = paid_for(cls.table)  # type: ignore[assignment,method-assign]

    def table(self) -> Table:
        """Return the answer as a table.

        Examples
        --------
        >>> import ropedyn as rd
        >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(2)
        >>> [round(f, 9) for f in modes.table().column("frequency [Hz]")]
        [25.0, 50.0]
        """
        raise NotImplementedError

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the answer.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; a new figure's where left out.

        Returns
        -------
        matplotlib.axes.Axes

        Examples
        --------
        >>> import ropedyn as rd
        >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(2)
        >>> modes.plot().get_xlabel()
        'position along the rope [m]'
        """
        return draw(self, "plot", ax)

    def __str__(self) -> str:
        return str(self.table())

    def __repr__(self) -> str:
        try:
            table = self.table()
            return repr(replace(table, title=f"{type(self).__name__}: {table.title}"))
        except (SceneError, SolveError) as error:
            return f"{type(self).__name__}: {error}"

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()

    def to_dataframe(self) -> pd.DataFrame:
        """Return the table as a pandas data frame.

        Raises
        ------
        ImportError
            If pandas is missing.

        Examples
        --------
        >>> import ropedyn as rd
        >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(2)
        >>> frame = modes.to_dataframe()
        >>> frame["frequency [Hz]"].round(9).tolist()
        [25.0, 50.0]
        """
        return self.table().to_dataframe()

    def to_json(self) -> str:
        """Return the table, and all that is said beside it, as JSON of "ropedyn.table/1".

        Examples
        --------
        >>> import json
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=90.0).compile()
        >>> sheet = json.loads(rd.compare(model, rd.Peaks([15.3, 30.0])).to_json())
        >>> sheet["rows"][1]["mode"], sheet["details"]["status"]
        (2, 'ambiguous')
        """
        kept = {"axes", "nested", "sheet", "transient"}
        plain = [one.name for one in fields(self) if kept.isdisjoint(one.metadata)]  # type: ignore[arg-type]
        details = {name: getattr(self, name) for name in (*plain, *self.said) if name != "cost"}
        return self.table().to_json({k: v for k, v in details.items() if v is not None})

    def to_xarray(self) -> xr.Dataset:
        """Return every array with its axes and units.

        Raises
        ------
        ImportError
            If xarray is missing.

        Examples
        --------
        >>> import ropedyn as rd
        >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(2)
        >>> dataset = modes.to_xarray()
        >>> dataset["frequency"].dims, dataset["frequency"].attrs["units"]
        (('mode',), 'Hz')
        """
        variables: dict[str, Any] = {}
        attributes: dict[str, Any] = {KIND: type(self).__name__}
        absent: dict[str, Any] = {}
        for item, value in leaves(self, absent):
            if "axes" not in item.metadata:
                attributes[PREFIX + item.name] = json.dumps(_plain(value))
                continue
            if value is None:
                continue
            names, unit = item.metadata["axes"], {"units": item.metadata["unit"]}
            if item.metadata["keyed"]:
                for key, array in value.items():
                    variables[f"{item.name}.{key}"] = (names, array, unit)
            else:
                # a leading axis that was not asked for is not there
                variables[item.name] = (names[len(names) - np.ndim(value) :], value, unit)
        if absent:
            attributes[ABSENT] = json.dumps(absent)
        return extra.xarray().Dataset(variables, attrs=attributes)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the answer as a netCDF file, whole or not at all.

        What cannot be computed, such as the energy of motion that has none, is absent in the file;
        who reads it there gets the same error. Links are followed, permissions and owner kept; of
        a file with several names (hard links) only this one gets the answer.

        Parameters
        ----------
        path : path
            Of the file; `load` reads it.

        Raises
        ------
        ImportError
            If xarray or h5netcdf is missing.
        OSError
            If the file cannot be written: the old one stays. What is no file, such as a folder or
            a device, is refused.

        Examples
        --------
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> import ropedyn as rd
        >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(2)
        >>> with TemporaryDirectory() as folder:
        ...     modes.save(Path(folder, "modes.nc"))
        ...     rd.load(Path(folder, "modes.nc")).frequency.round(9)
        array([25., 50.])
        """
        check.path(path)
        write_bytes(path, sealed(self))


def sealed(answer: Answer) -> bytes:
    """Return the content of the file of an answer."""
    extra.netcdf()
    dataset = answer.to_xarray()
    # netCDF knows no complex numbers: real and imaginary parts along a last axis
    for name in [n for n, v in dataset.data_vars.items() if np.iscomplexobj(v)]:
        value = dataset[name]
        parts = np.stack([value.values.real, value.values.imag], axis=-1)
        dataset[name] = ((*value.dims, "re_im"), parts, value.attrs)
    content = _netcdf(dataset)
    return content + _seal(content)


def _seal(content: bytes) -> bytes:
    """Return what ends a file: HDF5, which damage may keep busy for ever, does not read so far."""
    return SEAL + hashlib.sha256(content).digest()


def _netcdf(dataset: xr.Dataset) -> bytes:
    """Return the file in memory: h5py ends the process where a disk is full."""
    from xarray.backends import H5NetCDFStore

    content = io.BytesIO()
    with extra.h5netcdf().File(content, "w") as file:
        dataset.dump_to_store(H5NetCDFStore(file))
    return content.getvalue()


def named(name: str) -> object:
    """Import the kind of answer of a name; the package puts its own way in this place."""
    raise AttributeError(name)


def load(path: str | os.PathLike[str]) -> Any:
    """Read what the library saved: an answer, a scene, or a sweep over scenes.

    Parameters
    ----------
    path : path
        Of the file; a scene's ends in ``.toml``.

    Returns
    -------
    Answer, Scene or Sweep
        Of the kind that was saved.

    Raises
    ------
    ImportError
        If xarray or h5netcdf is missing.
    OSError
        If the file cannot be read.
    SceneError
        If it holds no answer of ropedyn, or no scene.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import ropedyn as rd
    >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(2)
    >>> with TemporaryDirectory() as folder:
    ...     modes.save(Path(folder, "modes.nc"))
    ...     type(rd.load(Path(folder, "modes.nc"))).__name__
    'Modes'
    """
    file = check.path(path)
    if file.suffix.lower() == ".toml":
        scene: Any = named("Scene")
        return scene.load(file)
    if not file.is_file():
        extra.netcdf()
        raise FileNotFoundError(f"path must be a file that Answer.save wrote, got {str(file)!r}")
    if zipfile.is_zipfile(file):
        many: Any = named("Sweep")
        return many.load(file)
    return unsealed(file.read_bytes(), file)


def unsealed(whole: bytes, file: Path) -> Any:
    """Return the answer that a file, or a part of it, holds."""
    xarray = extra.netcdf()
    content = whole[: -len(_seal(b""))]
    if whole != content + _seal(content):
        raise SceneError(
            "path must be a file that Answer.save wrote and nobody changed, got "
            f"{str(file)!r}, whose checksum is missing or wrong"
        )
    with (
        reading(file, "a netCDF file"),
        xarray.open_dataset(io.BytesIO(content), engine="h5netcdf") as opened,
    ):
        dataset = opened.load()
    name = str(dataset.attrs.get(KIND, ""))
    with suppress(AttributeError):
        named(name)
    kind = Answer.kinds.get(name)
    if kind is None:
        raise SceneError(f"path must be a file that Answer.save wrote, got {str(file)!r}")
    with reading(file, "a file that Answer.save wrote and nobody changed"):
        return _rebuilt(kind, dataset)


def _refused(kind: str, words: str) -> Any:
    """Say of a part that is absent in a file why it could not be computed."""
    raise {"SceneError": SceneError, "SolveError": SolveError}[kind](words)


def leaves(thing: Any, absent: dict[str, Any]) -> Iterator[tuple[Field[Any], Any]]:
    """Yield the fields of an answer with their values, those of its nested parts among them.

    Parts that cannot be computed are left out and named in `absent`, with their errors.
    """
    known = {}
    for item in (item for item in fields(thing) if "transient" not in item.metadata):
        try:
            known[item] = getattr(thing, item.name)  # what that costs is part of the cost
            if "sheet" in item.metadata:
                known[item] = item.metadata["sheet"](known[item])
        except (SceneError, SolveError) as error:
            absent[item.name] = [type(error).__name__, str(error)]
    for item, kept in known.items():
        value = kept if "sheet" in item.metadata else getattr(thing, item.name)
        if "nested" in item.metadata:
            yield from leaves(value, absent)
        else:
            yield item, value


def _rebuilt(kind: type[Any], dataset: Any) -> Any:
    arguments: dict[str, Any] = {}
    absent = json.loads(dataset.attrs.get(ABSENT, "{}"))
    for item in fields(kind):
        if "transient" in item.metadata:
            continue
        if item.name in absent:
            arguments[item.name] = partial(_refused, *absent[item.name])
        elif "nested" in item.metadata:
            arguments[item.name] = _rebuilt(item.metadata["nested"], dataset)
        elif "read" in item.metadata:
            value = json.loads(dataset.attrs[PREFIX + item.name])
            arguments[item.name] = item.metadata["read"](value)
        elif "axes" not in item.metadata:
            value = json.loads(dataset.attrs[PREFIX + item.name])
            arguments[item.name] = Cost(**value) if item.name == "cost" else _frozen(value)
        elif item.metadata["keyed"]:
            start = item.name + "."
            names = [name for name in dataset.variables if name.startswith(start)]
            arguments[item.name] = {n[len(start) :]: _array(dataset[n]) for n in names}
        elif item.name in dataset.variables or not _is_optional(item):
            arguments[item.name] = _array(dataset[item.name])
    return kind(**arguments)


def _is_optional(item: Field[Any]) -> bool:
    return item.default is None or (isinstance(item.default, Lazy) and item.default.optional)


def _array(variable: Any) -> np.ndarray[Any, Any]:
    value = np.array(variable.values)
    if variable.dims[-1:] == ("re_im",):
        return value[..., 0] + 1j * value[..., 1]
    return value.astype(str) if value.dtype.kind == "O" else value


def _plain(value: Any) -> Any:
    """Turn a field into what JSON knows."""
    if isinstance(value, Cost):
        return vars(value)
    return dict(value) if isinstance(value, Mapping) else value


def _frozen(value: Any) -> Any:
    """Turn JSON's lists back into tuples."""
    return tuple(_frozen(one) for one in value) if isinstance(value, list) else value
