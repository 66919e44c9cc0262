"""arrays: NumPy arrays as the library walks through them, without copies where it can."""
from __future__ import annotations

from typing import Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float32]


def _rows(array: np.ndarray, width: int, least: int = 4) -> Optional[np.ndarray]:
    """The array as [N, width] that the library can walk through, a view; None where it cannot.
    least: bytes from one row to the next."""
    if array.dtype != np.float32 or not array.flags.aligned:
        return None
    rows = array.reshape(-1, width)  # a view, or a copy where there is none
    if not np.may_share_memory(rows, array) and array.size:
        return None
    step, item = rows.strides
    well = (width == 1 or item == 4) and (len(rows) < 2 or (step >= least and step % 4 == 0))
    return rows if well else None


def input_rows(array: np.ndarray, width: int) -> np.ndarray:
    rows = _rows(array, width)
    if rows is None:
        rows = np.ascontiguousarray(array, np.float32).reshape(-1, width)
    return rows


def directions(name: str, array: ArrayLike, width: int = 3) -> np.ndarray:
    array = np.asarray(array)
    if array.ndim == 0 or array.shape[-1] != width:
        raise ValueError(f"{name} has the shape {array.shape}, expected [..., {width}]")
    return array


def walk(rows: np.ndarray) -> tuple[int, int]:
    """Address and stride in bytes."""
    return rows.ctypes.data, rows.strides[0] if len(rows) > 1 else rows.shape[1] * 4


def output_rows(out: Optional[np.ndarray], shape: tuple, width: int, inputs: Sequence[np.ndarray]
            ) -> tuple[np.ndarray, np.ndarray]:
    """What is returned, and its rows."""
    if out is None:
        out = np.empty(shape, np.float32)
    if out.shape != shape or not out.flags.writeable:
        raise ValueError(f"out has the shape {out.shape}, expected {shape} and writable")
    rows = _rows(out, width, 4 * width)
    if rows is None:
        raise ValueError("out: expected float32 with rows at one positive distance")
    if any(np.shares_memory(rows, array) for array in inputs):
        raise ValueError("out overlaps what is read")
    return out, rows
