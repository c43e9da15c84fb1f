"""Builds the C extension; everything else about the package is in pyproject.toml."""

import os
import shutil
import subprocess
import sys
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.modified import newer_group

HERE = Path(__file__).parent
NOT_LINUX = f"""ropedyn's C core is written and tested for Linux, with gcc or clang and the GNU C
library, not for {sys.platform}. On Windows build it in WSL, on a Mac in a container of Linux."""
NO_COMPILER = """ropedyn's C core is compiled when it is installed, and there is no {command!r}
to do so. Install a C compiler and Python's headers:
    Debian, Ubuntu   apt install gcc libc6-dev python3-dev
    Fedora           dnf install gcc python3-devel
    conda            conda install c-compiler
or name the one there is: CC=clang pip install ."""
NO_PKG_CONFIG = """ROPEDYN_SYSTEM_LAPACKE=1 asks pkg-config for the system's LAPACKE, and {problem}
On Debian
    apt install pkg-config liblapacke-dev libopenblas-dev
or without ROPEDYN_SYSTEM_LAPACKE the wheel scipy-openblas32 is taken."""
SYSTEM_LAPACKE = os.environ.get("ROPEDYN_SYSTEM_LAPACKE") == "1"

# -O3 takes ten times as long over the kernels of width 3 and 4 and makes them no faster, common
# subexpressions across blocks, or after registers are given, twice as long, and what a debugger
# reads, which some Pythons ask for, half as long again
QUICK = ["-O2", "-fno-gcse", "-fno-gcse-after-reload", "-g0"]
COMPILE = ([] if "CFLAGS" in os.environ else QUICK) + [
    "-std=c17",
    "-fvisibility=hidden",
    "-ffp-contract=off",
    "-fno-math-errno",  # so that roots of lanes are taken at once
    "-Wno-psabi",  # vector types never cross a function of the extension's interface
]

WIDE = ["-mmove-max=256", "-mstore-max=256"]
"""Lanes are copied by registers of 32 bytes: by 16 what is loaded as 32 waits for both stores."""


def wide(compiler):
    """Those flags where the compiler has them: gcc from 12 on, for x86."""
    probe = [compiler, *WIDE, "-x", "c", "-fsyntax-only", "/dev/null"]
    done = subprocess.run(probe, capture_output=True, check=False)
    return WIDE if done.returncode == 0 else []


def lapacke():
    """Where LAPACKE comes from: compiler and linker settings."""
    if SYSTEM_LAPACKE:
        command = ["pkg-config", "--cflags", "--libs", "lapacke", "openblas"]
        try:
            asked = subprocess.run(command, check=True, capture_output=True, text=True)
        except FileNotFoundError:
            sys.exit(NO_PKG_CONFIG.format(problem="there is none."))
        except subprocess.CalledProcessError as error:
            sys.exit(NO_PKG_CONFIG.format(problem=f"it says: {error.stderr.strip()}"))
        flags = asked.stdout.split()
        return {
            "include_dirs": [f[2:] for f in flags if f.startswith("-I")],
            "library_dirs": [f[2:] for f in flags if f.startswith("-L")],
            "libraries": [f[2:] for f in flags if f.startswith("-l")],
        }
    import scipy_openblas32

    return {
        "include_dirs": [scipy_openblas32.get_include_dir()],
        "library_dirs": [scipy_openblas32.get_lib_dir()],
        "libraries": ["scipy_openblas"],
        "extra_link_args": ["-Wl,-rpath,$ORIGIN/_libs"],
    }


class BuildExt(build_ext):
    """Builds the extension on all cores and copies the LAPACKE it links with beside it."""

    def build_extension(self, ext):
        """Compile side by side what has changed; setuptools takes all sources, one by one."""
        command = self.compiler.compiler_so[0]
        if shutil.which(command) is None:
            sys.exit(NO_COMPILER.format(command=command))
        compile_one = self.compiler.compile
        ext.extra_compile_args = [*COMPILE, *wide(command)]
        flags = [numpy.__version__, *self.compiler.compiler_so, *ext.extra_compile_args]
        if self.editable_mode:  # whose own folder is gone after each build
            tag = f"temp.{self.plat_name}-{sys.implementation.cache_tag}"
            self.build_temp = str(HERE / "build" / tag)
        self.build_temp += f"-{zlib.crc32(repr(flags).encode()):08x}"

        def compile_stale(source, *arguments, **keywords):
            (made,) = self.compiler.object_filenames([source], output_dir=self.build_temp)
            if self.force or newer_group([source, *ext.depends], made):
                compile_one([source], *arguments, **keywords)
            return made

        def compile_all(sources, *arguments, **keywords):
            with ThreadPoolExecutor(os.cpu_count()) as executor:
                parts = [
                    executor.submit(compile_stale, source, *arguments, **keywords)
                    for source in sources
                ]
                return [part.result() for part in parts]

        self.compiler.compile = compile_all
        super().build_extension(ext)

    def run(self):
        """Build, then put a fresh copy of the library and its licence into ropedyn/_libs."""
        super().run()
        inplace = self.inplace or self.editable_mode
        libraries = (HERE if inplace else Path(self.build_lib)) / "ropedyn" / "_libs"
        shutil.rmtree(libraries, ignore_errors=True)
        if SYSTEM_LAPACKE:
            return
        import scipy_openblas32

        libraries.mkdir(parents=True)
        for library in Path(scipy_openblas32.get_lib_dir()).glob("*.so*"):
            shutil.copy(library, libraries)
        package = Path(scipy_openblas32.__file__).parent
        licence = next(package.parent.glob("scipy_openblas32-*.dist-info/**/LICENSE*"))
        shutil.copy(licence, libraries / "LICENSE-OpenBLAS.txt")


if not sys.platform.startswith("linux"):
    sys.exit(NOT_LINUX)
settings = lapacke()
settings["include_dirs"] = ["csrc", numpy.get_include(), *settings["include_dirs"]]
core = Extension(
    "ropedyn._core",
    sources=sorted(str(f.relative_to(HERE)) for f in (HERE / "csrc").rglob("*.c")),
    depends=sorted(str(f.relative_to(HERE)) for f in (HERE / "csrc").rglob("*.h")),
    define_macros=[
        ("NPY_TARGET_VERSION", "NPY_1_23_API_VERSION"),
        ("NPY_NO_DEPRECATED_API", "NPY_1_7_API_VERSION"),
    ],
    extra_compile_args=COMPILE,
    **settings,
)

setup(ext_modules=[core], cmdclass={"build_ext": BuildExt})
