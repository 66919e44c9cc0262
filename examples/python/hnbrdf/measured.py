"""measured: measured materials and your own."""
from __future__ import annotations

import ctypes as c
import os
from typing import Any, Callable, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, directions
from .layouts import ENUMS, _P, _custom, _eval_fn, _measured_options, value_of
from .library import Handle, call, part

_MERL_BINS = 90, 90, 180  # theta_h = (i/90)^2 pi/2, theta_d = (j/90) pi/2, phi_d = (k/180) pi
_MERL_SCALE = np.array([1.0, 1.15, 1.66]) / 1500


class Measured:
    """A measured material, or one of your own, to be fitted and compared."""

    def __init__(self, pointer: int, keep: Any = None):
        """From an hnbrdf_measured *, which this object then owns: use open() and the like."""
        self._as_parameter_ = Handle(pointer, part("hnbrdf_measured").measured_close)
        self._as_parameter_._keep = keep
        self._caught: list[BaseException] = [] if keep is None else keep[1]

    @classmethod
    def _made(cls, function: Any, *arguments: Any, keep: Any = None) -> Measured:
        pointer = _P()
        call(function, *arguments, c.byref(pointer))
        return cls(pointer.value, keep)

    @classmethod
    def open(cls, path: Union[str, os.PathLike], **options: Any) -> Measured:
        """A file of MERL, RGL, UTIA or Neural-BRDF. Options are the members of
        hnbrdf_measured_options: merl_lookup="trilinear", rgl_signed=True, utia_scale=0.5."""
        words = {name: value_of(name, value) if name in ENUMS else value
                 for name, value in options.items()}
        unknown = set(words) - {name for name, _ in _measured_options._fields_}
        if unknown:
            raise TypeError(f"no option {', '.join(sorted(unknown))}")
        if str(path).endswith(".h5"):
            read = part("hnbrdf_hdf5").library.hnbrdf_hdf5_read
            words["read_hdf5"] = c.cast(read, _P)
        return cls._made(part("hnbrdf_measured").measured_open, os.fsencode(path),
                         c.byref(_measured_options(**words)))

    @classmethod
    def builtin(cls, name: str) -> Measured:
        """A built-in material by its name; builtin_names() tells them."""
        names = cls.builtin_names()
        if name not in names:
            raise KeyError(f"no built-in material {name!r}, there are {', '.join(names)}")
        return cls._made(part("hnbrdf_measured").measured_open_builtin, names.index(name))

    @staticmethod
    def builtin_names() -> list[str]:
        lib = part("hnbrdf_measured")
        count = lib.measured_builtin_count() + lib.measured_builtin_anisotropic_count()
        return [lib.measured_builtin_name(k).decode() for k in range(count)]

    @classmethod
    def custom(cls, name: str, function: Callable[[Sequence[float], Sequence[float]], Any],
               isotropic: bool = False) -> Measured:
        """function(wi, wo) gives the three numbers of f, or None where there is no value; wi and wo
        are lists of three floats. It is called pair by pair, some 100,000 times a fit:
        tabulated() is faster. isotropic: turning both about the normal changes nothing."""
        caught: list[BaseException] = []

        def evaluate(_user: Any, wi: Any, wo: Any, f: Any) -> int:
            try:
                value = None if caught else function(wi[:3], wo[:3])
                if value is None:
                    return 0
                f[0], f[1], f[2] = value
                return 1
            except BaseException as error:  # raised again by what called the library
                caught.append(error)
                return 0

        callback = _eval_fn(evaluate)
        custom = _custom(name.encode(), None, isotropic, callback)
        return cls._made(part("hnbrdf_measured").measured_create_custom, c.byref(custom),
                         keep=(callback, caught))

    @classmethod
    def table(cls, name: str, table: ArrayLike, interpolate: bool = False) -> Measured:
        """Values in the bins of MERL, [90, 90, 180, 3]: theta_h = (i/90)^2 pi/2, theta_d =
        (j/90) pi/2, phi_d = (k/180) pi at their lower edges. Isotropic, reciprocal. A bin with a
        negative channel or one that is not finite holds no measurement. interpolate: between the
        centres of 8 bins; else f is constant in each."""
        table = np.array(table, np.float64)
        if table.shape != (*_MERL_BINS, 3):
            raise ValueError(f"table has the shape {table.shape}, expected {(*_MERL_BINS, 3)}")
        table[~np.all(np.isfinite(table) & (table >= 0), axis=-1)] = -1
        data = (np.array(_MERL_BINS, "<i4").tobytes() +
                np.moveaxis(table / _MERL_SCALE, -1, 0).astype("<f8").tobytes())
        options = _measured_options(merl_lookup=int(interpolate))
        made = cls._made(part("hnbrdf_measured").measured_open_memory, data, len(data),
                         f"{name}.binary".encode(), c.byref(options))
        if made.name != name:
            raise ValueError(f"{name!r} would become {made.name!r}, choose another name")
        return made

    @classmethod
    def samples(cls, name: str, wi: ArrayLike, wo: ArrayLike, f: ArrayLike,
                bins: tuple[int, int, int] = (90, 90, 180)) -> Measured:
        """Scattered measurements, wi, wo and f [N, 3]: averaged in these numbers of bins of
        theta_h, theta_d and phi_d, which divide 90, 90 and 180. An isotropic material; a fit leaves
        out the bins without a sample, and needs samples in 1 % of the directions it draws: take few
        bins for few."""
        if any(whole % part for whole, part in zip(_MERL_BINS, bins)):
            raise ValueError(f"bins {bins}: expected divisors of {_MERL_BINS}")
        wi, wo, f = (directions(word, array).reshape(-1, 3).astype(np.float64)
                     for word, array in (("wi", wi), ("wo", wo), ("f", f)))
        good = np.isfinite(f).all(1) & (wi[:, 2] > 0) & (wo[:, 2] > 0)
        place = [np.minimum((part * share).astype(int), part - 1)
                 for part, share in zip(bins, _to_merl(wi[good], wo[good]))]
        at, count = np.ravel_multi_index(place, bins), int(np.prod(bins))
        number = np.bincount(at, minlength=count)
        total = np.stack([np.bincount(at, f[good, ch], count) for ch in range(3)], -1)
        with np.errstate(invalid="ignore"):
            table = (total / number[:, None]).reshape(*bins, 3)
        for axis, (whole, part) in enumerate(zip(_MERL_BINS, bins)):
            table = table.repeat(whole // part, axis)
        return cls.table(name, table)

    @classmethod
    def tabulated(cls, name: str, function: Callable[[Array, Array], ArrayLike]) -> Measured:
        """An isotropic, reciprocal formula: function(wi, wo) of arrays [N, 3] gives [N, 3],
        negative or NaN where there is no value. Tabulated at the centres of MERL's bins, which are
        narrowest near the highlight, with interpolation between them."""
        table = np.full((*_MERL_BINS, 3), -1.0)
        for row in range(_MERL_BINS[0]):
            wi, wo = _from_merl(row)
            above = (wi[..., 2] > 0) & (wo[..., 2] > 0)
            if above.any():
                value = function(wi[above].astype(np.float32), wo[above].astype(np.float32))
                table[row][above] = value
        return cls.table(name, table, True)

    @property
    def name(self) -> str:
        return part("hnbrdf_measured").measured_name(self).decode()

    @property
    def summary(self) -> str:
        """What it holds and how it is read, in one line."""
        return part("hnbrdf_measured").measured_summary(self).decode(errors="replace")

    @property
    def isotropic(self) -> bool:
        return bool(part("hnbrdf_measured").measured_is_isotropic(self))

    def evaluate(self, wi: ArrayLike, wo: ArrayLike) -> Array:
        """f of [..., 3] and [..., 3], one by one; NaN where nothing was measured."""
        wi, wo = np.broadcast_arrays(directions("wi", wi), directions("wo", wo))
        out, function = np.empty(wi.shape, np.float32), part("hnbrdf_measured").measured_eval
        places = zip(np.ascontiguousarray(wi, np.float32).reshape(-1, 3),
                     np.ascontiguousarray(wo, np.float32).reshape(-1, 3), out.reshape(-1, 3))
        for a, b, f in places:
            if not function(self, a.ctypes.data, b.ctypes.data, f.ctypes.data):
                f[:] = np.nan
        if self._caught:
            raise self._caught.pop()
        return out


def _to_merl(wi: np.ndarray, wo: np.ndarray) -> tuple[np.ndarray, ...]:
    """sqrt(theta_h/(pi/2)), theta_d/(pi/2) and phi_d/pi of [N, 3], in [0, 1]."""
    h = wi + wo
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    across, phi = np.hypot(h[:, 0], h[:, 1]), np.arctan2(h[:, 1], h[:, 0])
    x = np.cos(phi) * wi[:, 0] + np.sin(phi) * wi[:, 1]
    y = np.cos(phi) * wi[:, 1] - np.sin(phi) * wi[:, 0]
    x, z = h[:, 2] * x - across * wi[:, 2], across * x + h[:, 2] * wi[:, 2]
    turn = np.arctan2(y, x)
    turn = np.where(turn < 0, turn + np.pi, np.where(turn >= np.pi, 0, turn))
    return (np.sqrt(np.arctan2(across, h[:, 2]) / (np.pi / 2)),
            np.arctan2(np.hypot(x, y), z) / (np.pi / 2), turn / np.pi)


def _from_merl(row: int) -> tuple[np.ndarray, np.ndarray]:
    """Directions of the centres of the bins [90, 180] of one theta_h."""
    th = ((row + 0.5) / _MERL_BINS[0]) ** 2 * np.pi / 2
    td = ((np.arange(_MERL_BINS[1]) + 0.5) / _MERL_BINS[1] * np.pi / 2)[:, None]
    pd = (np.arange(_MERL_BINS[2]) + 0.5) / _MERL_BINS[2] * np.pi
    both = []
    for sign in 1, -1:
        x, y, z = np.broadcast_arrays(sign * np.sin(td) * np.cos(pd),
                                      sign * np.sin(td) * np.sin(pd), np.cos(td))
        both.append(np.stack([np.cos(th) * x + np.sin(th) * z, y,
                              np.cos(th) * z - np.sin(th) * x], -1))
    return both[0], both[1]
