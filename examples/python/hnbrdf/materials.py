"""materials: items of material_dtype, made, checked, changed and mixed."""
from __future__ import annotations

import dataclasses
from typing import Optional, Union

import numpy as np

from .layouts import MIX_KNOTS, material_dtype
from .library import call, part

Material = Union[np.void, np.ndarray]


def record(material: Material) -> np.ndarray:
    """One material as an array of shape (), of our layout."""
    if not isinstance(material, (np.void, np.ndarray)) or material.dtype != material_dtype:
        raise TypeError("expected a material: an item of material_dtype")
    if material.shape != ():
        raise ValueError(f"expected one material, found an array of shape {material.shape}")
    return np.ascontiguousarray(material).reshape(())


def material(text: str = "") -> np.void:
    """A new material: kd 0.5, eta 1.5, alpha 0.5, latent 0, then what text says, as in assign()."""
    made = np.zeros((), material_dtype)
    part("hnbrdf").material_init(made.ctypes.data)
    return assign(made[()], text) if text else made[()]


def check(material: Material) -> None:
    """Raises Error where a field is out of its range; evaluation trusts that none is."""
    call(part("hnbrdf").material_check, record(material).ctypes.data)


def assign(material: Material, text: str) -> np.void:
    """The material changed as a text says: "alpha=0.1:0.4,kd*=0.5,rotation=30deg"."""
    made = record(material).copy()
    call(part("hnbrdf").material_set, made.ctypes.data, text.encode())
    return made[()]


def is_edited(material: Material) -> bool:
    """Whether kd, eta or alpha are not what the network was fitted with."""
    return bool(part("hnbrdf").material_is_edited(record(material).ctypes.data))


def mix(a: Material, b: Material, t: float) -> np.void:
    """The material at t in [0, 1] on the straight way from a to b. Model.mix_path() is better."""
    made = np.zeros((), material_dtype)
    part("hnbrdf").material_mix(record(a).ctypes.data, record(b).ctypes.data, t,
                                 made.ctypes.data)
    return made[()]


def mix_at(path: np.ndarray, t: float) -> np.void:
    """The material at t in [0, 1] on a path of Model.mix_path()."""
    if path.dtype != material_dtype or path.shape != (MIX_KNOTS,):
        raise ValueError(f"expected a path of {MIX_KNOTS} materials")
    path, made = np.ascontiguousarray(path), np.zeros((), material_dtype)
    part("hnbrdf").mix_path_at(path.ctypes.data, t, made.ctypes.data)
    return made[()]


@dataclasses.dataclass
class Change:
    """One change of Model.edit(): kind is put (add or replace), add, replace, remove, rename (to
    new_name) or lobes (those for sampling alone; name None: of every material). lobes: keep, fit
    (20 ms a material), paper or guess."""
    kind: str
    name: Optional[str]
    material: Optional[Material] = None
    new_name: Optional[str] = None
    lobes: str = "keep"
