"""library: finds and loads the shared libraries; their functions, errors and notes."""
from __future__ import annotations

import ctypes as c
import enum
import os
import pathlib
import sys
import weakref
from typing import Any, Callable, Optional, Union

from .layouts import INTERFACE, _D, _F, _I, _P, _S, _Z, _error, _note_fn, _notes, _write_fn

# Of each function: what it returns, then what it takes. Every pointer is _P.
FUNCTIONS: dict[str, dict[str, tuple]] = {
    "hnbrdf": {
        "version": (_S,), "material_init": (None, _P), "material_check": (_I, _P, _P),
        "material_is_edited": (_I, _P), "material_mix": (None, _P, _P, _F, _P),
        "model_create": (_I, _P, _P, _P, _P), "model_load": (_I, _S, _P, _P, _P),
        "model_load_memory": (_I, _P, _Z, _P, _P, _P), "model_save": (_I, _P, _S, _P),
        "model_write": (_I, _P, _write_fn, _P, _P), "model_free": (None, _P),
        "model_describe": (None, _P, _P), "model_multiplications": (_Z, _P),
        "eval_batch": (None, _P, _P, _Z, _P, _Z, _P, _Z, _P, _Z),
        "eval_many": (None, _P, _P, _P, _Z, _P, _Z, _P, _Z, _P, _Z),
        "eval_analytic_batch": (None, _P, _P, _Z, _P, _Z, _P, _Z, _P, _Z),
        "prepare": (None, _P, _P, _P),
        "prepared_sample_batch": (None, _P, _Z, _P, _Z, _P, _Z, _P, _Z),
        "prepared_pdf_batch": (None, _P, _Z, _P, _Z, _P, _Z, _P, _Z),
        "sample_many": (None, _P, _P, _P, _Z, _P, _Z, _P, _Z, _P, _Z),
        "pdf_many": (None, _P, _P, _P, _Z, _P, _Z, _P, _Z, _P, _Z),
        "model_with_materials": (_I, _P, _P, _I, _P, _P, _P), "material_set": (_I, _P, _S, _P),
        "mix_path_fit": (_I, _P, _P, _P, _P, _P), "mix_path_at": (None, _P, _F, _P),
        "shading_language_from_name": (_I, _S, _P),
        "export_shader": (_I, _P, _P, _write_fn, _P, _P)},
    "hnbrdf_measured": {
        "measured_open": (_I, _S, _P, _P, _P),
        "measured_open_memory": (_I, _P, _Z, _S, _P, _P, _P),
        "measured_builtin_count": (_I,), "measured_builtin_anisotropic_count": (_I,),
        "measured_builtin_name": (_S, _I),
        "measured_open_builtin": (_I, _I, _P, _P), "measured_create_custom": (_I, _P, _P, _P),
        "measured_close": (None, _P), "measured_name": (_S, _P), "measured_summary": (_S, _P),
        "measured_is_isotropic": (_I, _P), "measured_eval": (_I, _P, _P, _P, _P)},
    "hnbrdf_hdf5": {},
    "hnbrdf_metrics": {"compare": (_I, _P, _P, _P, _I, _Z, c.c_uint64, _P, _P)},
    "hnbrdf_fit": {"fit": (_I, _P, _I, _P, _P, _P, _P)},
}
_folder: Optional[str] = None
_loaded: dict[str, Any] = {}


def use_libraries(folder: Union[str, os.PathLike, None]) -> None:
    """The folder of the shared libraries from now on; None: look for them. Before anything else."""
    global _folder
    if _loaded:
        raise RuntimeError("use_libraries(): the libraries are loaded already")
    _folder = None if folder is None else os.fspath(folder)


def _open(part: str) -> c.CDLL:
    chosen = _folder or os.environ.get("HNBRDF_LIBRARY_PATH")
    here = pathlib.Path(__file__).resolve().parent
    folders = [pathlib.Path(chosen)] if chosen else [here, here / "../../../build"]
    name = {"darwin": f"lib{part}.{INTERFACE}.dylib", "win32": f"lib{part}.dll"}.get(
        sys.platform, f"lib{part}.so.{INTERFACE}")
    for folder in folders:
        if (folder / name).exists():
            return c.CDLL(str(folder / name))
    if not chosen:
        try:
            return c.CDLL(name)
        except OSError:
            pass
    where = ", ".join(str(folder) for folder in folders) + ("" if chosen else " or the system's")
    raise ImportError(f"{name} is not in {where}: set HNBRDF_LIBRARY_PATH to its folder")


def part(part: str) -> Any:
    """The functions of one library, by their names without hnbrdf_."""
    if part not in _loaded:
        library, functions = _open(part), type(part, (), {})()
        for name, (result, *arguments) in FUNCTIONS[part].items():
            function = getattr(library, "hnbrdf_" + name)
            function.restype, function.argtypes = result, arguments
            setattr(functions, name, function)
        if part == "hnbrdf" and not functions.version().decode().startswith(INTERFACE + "."):
            raise ImportError(f"libhnbrdf is version {functions.version().decode()}, this file is "
                              f"for {INTERFACE}")
        functions.library = library
        _loaded[part] = functions
    return _loaded[part]


class Result(enum.IntEnum):
    """hnbrdf_result."""
    OK, ARGUMENT, IO, FORMAT, UNSUPPORTED, LIMIT, MEMORY, CANCELLED = range(8)


class Error(Exception):
    """What the library refused, in its one line: file, place, what was found and expected."""

    def __init__(self, result: int, text: str):
        super().__init__(text)
        self.result = Result(result)


def call(function: Any, *arguments: Any) -> None:
    """Calls what returns an hnbrdf_result and takes an hnbrdf_error last."""
    error = _error()
    result = function(*arguments, c.byref(error))
    if result:
        raise Error(result, error.text.decode(errors="replace"))


def told(lines: list[str]) -> Any:
    """hnbrdf_notes that collect lines."""
    return _notes(_note_fn(lambda _user, line: lines.append(line.decode(errors="replace"))))


def written(function: Any, *arguments: Any) -> bytes:
    """What a function hands to an hnbrdf_write_fn, its last but two arguments."""
    parts: list[bytes] = []

    def write(_user: Any, data: int, size: int) -> int:
        parts.append(c.string_at(data, size))
        return 0

    call(function, *arguments, _write_fn(write), None)
    return b"".join(parts)


class Handle:
    """Owns a pointer of the library. Views of its memory hold it too, and it holds none of them."""

    def __init__(self, pointer: int, free: Any):
        self._as_parameter_ = pointer
        weakref.finalize(self, free, pointer)


def dictionary(structure: Any) -> dict[str, Any]:
    made = {}
    for name, kind in structure._fields_:
        value = getattr(structure, name)
        if isinstance(value, c.Structure):
            value = dictionary(value)
        made[name] = value.decode() if isinstance(value, bytes) else value
    return made
