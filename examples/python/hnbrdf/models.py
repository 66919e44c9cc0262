"""models: a network with its materials: evaluate, sample, edit, save, export."""
from __future__ import annotations

import ctypes as c
import dataclasses
import os
import warnings
from typing import Any, Iterable, NamedTuple, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, directions, input_rows, output_rows, walk
from .layouts import (MAX_LAYERS, MIX_KNOTS, _P, _S, _change, _desc, _glsl_options, _load_options,
                      _prepared, value_of, words_of, material_dtype, sample_dtype)
from .library import Handle, call, part, told, written
from .materials import Change, record


class Samples(NamedTuple):
    """Directions drawn: wi [..., 3] unit vectors; pdf [...] in 1/sr, 0 where there is none; weight
    [..., 3], f wi.z / pdf."""
    wi: Array
    pdf: Array
    weight: Array


@dataclasses.dataclass
class Description:
    """What a model holds, hnbrdf_model_desc. weights[k] is [out, in] and biases[k] [out] of layer
    k; in is 6 + latent for the first, the encoded directions before the latent code. materials is
    an array [M] of material_dtype. From Model.describe() arrays are read-only views."""
    kind: str
    encoding: str = "directions"
    weights: Sequence[ArrayLike] = ()
    biases: Sequence[ArrayLike] = ()
    materials: Any = ()
    names: Sequence[str] = ()
    latent: int = 0
    scale: float = 1.0
    shift: float = 0.0
    floor: float = 0.0
    variant: str = "auto"


class Model:
    """An immutable network with its materials. model[NAME] is a copy of a material, to be edited;
    model.materials a view of all, [M]; model.names their names."""

    def __init__(self, pointer: int):
        """From an hnbrdf_model *, which this object then owns: use load() and the like."""
        self._as_parameter_ = Handle(pointer, part("hnbrdf").model_free)
        desc = self._desc()
        self.names: tuple[str, ...] = tuple(
            desc.names[k].decode() for k in range(desc.material_count))
        self.materials: np.ndarray = self._view(desc.materials, (len(self.names),), material_dtype)
        self._index = {name: k for k, name in enumerate(self.names)}

    @classmethod
    def _made(cls, function: Any, *arguments: Any, notes: Sequence[str] = ()) -> Model:
        pointer = _P()
        call(function, *arguments, c.byref(pointer))
        for line in notes:
            warnings.warn(line, stacklevel=3)
        return cls(pointer.value)

    @classmethod
    def load(cls, path: Union[str, os.PathLike], variant: str = "auto") -> Model:
        """Reads a model file. variant: the instructions to evaluate with; all give equal bits."""
        lines: list[str] = []
        options = _load_options(variant=value_of("variant", variant), notes=told(lines))
        return cls._made(part("hnbrdf").model_load, os.fsencode(path), c.byref(options),
                         notes=lines)

    @classmethod
    def from_bytes(cls, data: bytes, variant: str = "auto") -> Model:
        """The same from the bytes of a file."""
        lines: list[str] = []
        options = _load_options(variant=value_of("variant", variant), notes=told(lines))
        return cls._made(part("hnbrdf").model_load_memory, data, len(data), c.byref(options),
                         notes=lines)

    @classmethod
    def create(cls, description: Description) -> Model:
        """Builds a model from arrays, which are copied and checked."""
        d = description
        weights = [np.ascontiguousarray(array, np.float32) for array in d.weights]
        biases = [np.ascontiguousarray(array, np.float32) for array in d.biases]
        materials = np.ascontiguousarray(d.materials, material_dtype)
        if materials.shape != (len(d.names),):
            raise ValueError(f"materials has the shape {materials.shape}, expected one each of "
                             f"{len(d.names)} names")
        hidden, layers = (len(biases[0]), len(weights) - 1) if weights else (0, 0)
        if layers > MAX_LAYERS or len(biases) != len(weights):
            raise ValueError(f"{len(weights)} weights and {len(biases)} biases, expected as many, "
                             f"and at most {MAX_LAYERS + 1}")
        for k, (weight, bias) in enumerate(zip(weights, biases)):
            out = hidden if k < layers else 3 if d.kind == "neural" else 6
            expected = out, hidden if k else 6 + d.latent
            if weight.shape != expected or bias.shape != (out,):
                raise ValueError(f"layer {k}: weights {weight.shape} and biases {bias.shape}, "
                                 f"expected {expected} and ({out},)")
        desc = _desc(value_of("kind", d.kind), value_of("encoding", d.encoding), hidden, layers,
                     d.latent, d.scale, d.shift, d.floor, material_count=len(d.names),
                     materials=materials.ctypes.data, variant=value_of("variant", d.variant))
        for k, (weight, bias) in enumerate(zip(weights, biases)):
            desc.weights[k], desc.biases[k] = weight.ctypes.data, bias.ctypes.data
        desc.names = (_S * len(d.names))(*(name.encode() for name in d.names))
        return cls._made(part("hnbrdf").model_create, c.byref(desc), None)

    def _desc(self) -> Any:
        desc = _desc()
        part("hnbrdf").model_describe(self, c.byref(desc))
        return desc

    def _view(self, address: int, shape: tuple, dtype: Any = np.float32) -> np.ndarray:
        """A read-only array of memory of the model, which lives as long as the array."""
        size = int(np.prod(shape)) * np.dtype(dtype).itemsize
        memory = (c.c_char * size).from_address(address)
        memory._owner = self._as_parameter_
        view = np.frombuffer(memory, dtype).reshape(shape)
        view.flags.writeable = False
        return view

    def describe(self) -> Description:
        """Everything the model holds; arrays are views. Model.create() is the way back."""
        d = self._desc()
        weights, biases = [], []
        for k in range(d.layers + 1 if d.hidden else 0):
            out = d.hidden if k < d.layers else 3 if d.kind == 1 else 6
            weights.append(self._view(d.weights[k], (out, d.hidden if k else 6 + d.latent)))
            biases.append(self._view(d.biases[k], (out,)))
        return Description(words_of("kind")[d.kind], words_of("encoding")[d.encoding], weights,
                           biases, self.materials, self.names, d.latent, d.scale, d.shift, d.floor,
                           words_of("variant")[d.variant])

    def __len__(self) -> int:
        return len(self.names)

    def __contains__(self, name: str) -> bool:
        return name in self._index

    def __getitem__(self, name: str) -> np.void:
        return self.materials[self._at(name)].copy()

    def _at(self, name: str) -> int:
        if name not in self._index:
            raise KeyError(f"no material {name!r}, there are {', '.join(self.names)}")
        return self._index[name]

    @property
    def multiplications(self) -> int:
        """Of one evaluation of the network."""
        return part("hnbrdf").model_multiplications(self)

    # -- Evaluation. Each item has the bits of the C function for one pair. ------------------------

    def _chosen(self, chosen: Any, index: Optional[ArrayLike], shape: tuple
                ) -> tuple[np.ndarray, Optional[np.ndarray]]:
        """Materials [M] and the int32 index of each item, None for one material for all."""
        if chosen is None:
            chosen = self.materials
        elif isinstance(chosen, str):
            at = self._at(chosen)
            chosen = self.materials[at:at + 1].reshape(())
        elif isinstance(chosen, (list, tuple)):
            chosen = self.materials[[self._at(name) for name in chosen]]
        if isinstance(chosen, np.void) or np.ndim(chosen) == 0:
            if index is not None:
                raise ValueError("index: there is one material only")
            return record(chosen), None
        if chosen.dtype != material_dtype or chosen.ndim != 1:
            raise TypeError("expected names, or an array [M] of material_dtype")
        count = int(np.prod(shape))
        if index is None:
            if len(chosen) != count:
                raise ValueError(f"{len(chosen)} materials for {count} items, and no index")
            return np.ascontiguousarray(chosen), np.arange(count, dtype=np.int32)
        index = np.asarray(index)
        if index.dtype.kind not in "iu":
            raise TypeError("index: expected integers")
        index = np.broadcast_to(index, shape).reshape(-1)
        if count and not (0 <= index.min() and index.max() < len(chosen)):
            raise IndexError(f"index {index.min()} to {index.max()}, expected 0 to "
                             f"{len(chosen) - 1}")
        return np.ascontiguousarray(chosen), np.ascontiguousarray(index, np.int32)

    def _values(self, one: Any, many: Any, wi: ArrayLike, wo: ArrayLike, chosen: Any, index: Any,
                out: Optional[np.ndarray], width: int) -> np.ndarray:
        wi, wo = np.broadcast_arrays(directions("wi", wi), directions("wo", wo))
        materials, index = self._chosen(chosen, index, wi.shape[:-1])
        inputs = [input_rows(wi, 3), input_rows(wo, 3)]
        shape = wi.shape if width == 3 else wi.shape[:-1]
        out, rows = output_rows(out, shape, width, inputs)
        walks = [word for array in (*inputs, rows) for word in walk(array)]
        if index is None:
            one(materials.ctypes.data, len(rows), *walks)
        else:
            many(self, materials.ctypes.data, index.ctypes.data, len(rows), *walks)
        return out

    def evaluate(self, wi: ArrayLike, wo: ArrayLike, material: Any = None,
                 index: Optional[ArrayLike] = None, out: Optional[Array] = None) -> Array:
        """f of wi [..., 3] and wo [..., 3]: [..., 3] in 1/sr, without the cosine; 0 below the
        horizon. material: a name, or a material (edited, mixed); or many, names or an array [M]
        (None: those of the model), of which item k has the one at index[k], or the k-th. out:
        float32, written to and returned."""
        lib = part("hnbrdf")
        return self._values(lambda *a: lib.eval_batch(self, *a), lib.eval_many, wi, wo, material,
                            index, out, 3)

    def evaluate_analytic(self, wi: ArrayLike, wo: ArrayLike, material: Any,
                          out: Optional[Array] = None) -> Array:
        """The same of Lambert and GGX alone, for one material."""
        return self._values(lambda *a: part("hnbrdf").eval_analytic_batch(self, *a), None, wi, wo,
                            self._one(material), None, out, 3)

    def _one(self, chosen: Any) -> np.ndarray:
        return self._chosen(chosen, None, ())[0].reshape(())

    def _prepared(self, address: int) -> Any:
        prepared = _prepared()
        part("hnbrdf").prepare(self, address, c.byref(prepared))
        return c.byref(prepared)

    def pdf(self, wi: ArrayLike, wo: ArrayLike, material: Any = None,
            index: Optional[ArrayLike] = None, out: Optional[Array] = None) -> Array:
        """Density [...] in 1/sr with which sample() draws wi given wo; chosen as in evaluate()."""
        lib = part("hnbrdf")

        def one(address: int, *rest: Any) -> None:
            lib.prepared_pdf_batch(self._prepared(address), *rest)

        return self._values(one, lib.pdf_many, wi, wo, material, index, out, 1)

    def sample(self, wo: ArrayLike, u: ArrayLike, material: Any = None,
               index: Optional[ArrayLike] = None) -> Samples:
        """Draws wi given wo [..., 3], with u [..., 2] in [0, 1); material as in evaluate()."""
        lib, wo, u = part("hnbrdf"), directions("wo", wo), directions("u", u, 2)
        shape = np.broadcast_shapes(wo.shape[:-1], u.shape[:-1])
        wo, u = np.broadcast_to(wo, (*shape, 3)), np.broadcast_to(u, (*shape, 2))
        materials, index = self._chosen(material, index, shape)
        inputs, results = (input_rows(wo, 3), input_rows(u, 2)), np.empty(shape, sample_dtype)
        walks = [word for array in inputs for word in walk(array)] + [results.ctypes.data, 0]
        if index is None:
            lib.prepared_sample_batch(self._prepared(materials.ctypes.data), results.size, *walks)
        else:
            lib.sample_many(self, materials.ctypes.data, index.ctypes.data, results.size, *walks)
        return Samples(results["wi"], results["pdf"], results["weight"])

    # -- Other models and files --------------------------------------------------------------------

    def edit(self, changes: Iterable[Change]) -> Model:
        """A model with these changes, made in order. The network keeps its bits."""
        changes = list(changes)
        kept = [None if change.material is None else record(change.material) for change in changes]
        array = (_change * len(changes))()
        for k, change in enumerate(changes):
            array[k] = _change(
                value_of("change", change.kind),
                None if change.name is None else change.name.encode(),
                None if kept[k] is None else kept[k].ctypes.data,
                None if change.new_name is None else change.new_name.encode(),
                value_of("lobes", change.lobes))
        return self._made(part("hnbrdf").model_with_materials, self, array, len(changes), None)

    def mix_path(self, a: Any, b: Any) -> np.ndarray:
        """The way from a to b, names or materials, that looks like something all along: [33], for
        mix_at(). A tenth of a second."""
        a, b, path = self._one(a), self._one(b), np.zeros(MIX_KNOTS, material_dtype)
        call(part("hnbrdf").mix_path_fit, self, a.ctypes.data, b.ctypes.data, path.ctypes.data)
        return path

    def save(self, path: Union[str, os.PathLike]) -> None:
        """Writes a model file, whole or not at all."""
        call(part("hnbrdf").model_save, self, os.fsencode(path))

    def to_bytes(self) -> bytes:
        """What save() writes."""
        return written(part("hnbrdf").model_write, self)

    def export_shader(self, materials: Optional[Sequence[str]] = None, language: str = "glsl", *,
                      weights: str = "constants", precision: str = "float",
                      only: str = "everything", prefix: Optional[str] = None, **flags: bool) -> str:
        """A shader include with the network and these materials (None: all). flags are standalone, fixed, editable, exact, without_comments, and library: the part that
        all models share. `hnbrdf export --help` says what each does."""
        allowed = {"standalone", "fixed", "editable", "exact", "without_comments", "library"}
        if set(flags) - allowed:
            raise TypeError(f"no option {', '.join(sorted(set(flags) - allowed))}, expected one of "
                            f"{', '.join(sorted(allowed))}")
        number = c.c_int()
        if not part("hnbrdf").shading_language_from_name(language.encode(), c.byref(number)):
            raise ValueError(f"language {language!r}: the library does not write it")
        indices = None if materials is None else np.array(
            [self._at(name) for name in materials], np.int32)
        options = _glsl_options(
            materials=None if indices is None else indices.ctypes.data,
            material_count=0 if indices is None else len(indices),
            weights=value_of("weights", weights), precision=value_of("precision", precision),
            only=value_of("only", only), language=number.value,
            prefix=None if prefix is None else prefix.encode(), **flags)
        return written(part("hnbrdf").export_shader, self, c.byref(options)).decode()
