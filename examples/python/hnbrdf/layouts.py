"""layouts: structures and enums of the C headers. tests/test_python.sh compares each with them."""
from __future__ import annotations

import ctypes as c

import numpy as np

INTERFACE = "0.2"  # the version of the C interface that these are of
MAX_LATENT, MAX_LAYERS, MIX_KNOTS = 16, 4, 33

material_dtype = np.dtype([
    ("kd", "f4", 3), ("eta", "f4", 3), ("alpha", "f4", 2), ("rotation", "f4"),
    ("latent", "f4", MAX_LATENT),
    ("lobes", [("scale", "f4", 2), ("share", "f4", (2, 4))]),
    ("fitted", [("kd", "f4", 3), ("eta", "f4", 3), ("alpha", "f4", 2)]),
    ("energy", [("horizon", "f4"), ("slope", "f4")])])
"""A material as an item of a NumPy array, 180 bytes; hnbrdf_material says what the fields mean."""
sample_dtype = np.dtype([("wi", "f4", 3), ("pdf", "f4"), ("weight", "f4", 3)])

_P, _I, _Z, _F, _S, _D = c.c_void_p, c.c_int, c.c_size_t, c.c_float, c.c_char_p, c.c_double
_note_fn = c.CFUNCTYPE(None, _P, _S)
_write_fn = c.CFUNCTYPE(_I, _P, _P, _Z)
_eval_fn = c.CFUNCTYPE(_I, _P, c.POINTER(_F), c.POINTER(_F), c.POINTER(_F))
_fit_fn = c.CFUNCTYPE(_I, _P, _P)


def _structure(name: str, *fields: tuple) -> type:
    return type(name, (c.Structure,), {"_fields_": list(fields)})


_error = _structure("hnbrdf_error", ("text", c.c_char * 384))
_notes = _structure("hnbrdf_notes", ("note", _note_fn), ("user", _P))
_allocator = _structure("hnbrdf_allocator", ("allocate", _P), ("release", _P), ("user", _P))
_desc = _structure(
    "hnbrdf_model_desc", ("kind", _I), ("encoding", _I), ("hidden", _I), ("layers", _I),
    ("latent", _I), ("scale", _F), ("shift", _F), ("floor", _F),
    ("weights", _P * (MAX_LAYERS + 1)), ("biases", _P * (MAX_LAYERS + 1)),
    ("material_count", _I), ("materials", _P), ("names", c.POINTER(_S)), ("variant", _I))
_load_options = _structure(
    "hnbrdf_load_options", ("allocator", _allocator), ("max_bytes", _Z), ("read", _P),
    ("read_user", _P), ("variant", _I), ("notes", _notes))
_prepared_edit = _structure(
    "hnbrdf_prepared_edit", ("warp", _F * 2), ("alpha", _F * 2), ("area", _F), ("diffuse", _F * 4),
    ("e", _F * 4), ("carried", _F * 4), ("added", _F * 4))
_lobes = _structure("hnbrdf_lobes", ("scale", _F * 2), ("share", (_F * 4) * 2))
_energy = _structure("hnbrdf_energy", ("horizon", _F), ("slope", _F))
_prepared = _structure(
    "hnbrdf_prepared", ("model", _P), ("cosine", _F), ("sine", _F), ("alpha", _F * 2), ("area", _F),
    ("lobe_alpha", (_F * 2) * 2), ("lobe_area", _F * 2), ("lobes", _lobes), ("diffuse", _F * 4),
    ("e", _F * 4), ("first", _F * 64), ("edited", _I), ("edit", _prepared_edit),
    ("conserved", _I), ("energy", _energy))
_change = _structure("hnbrdf_material_change", ("kind", _I), ("name", _S), ("material", _P),
                     ("new_name", _S), ("lobes", _I))
_glsl_options = _structure(
    "hnbrdf_glsl_options", ("materials", _P), ("material_count", _I), ("standalone", _I),
    ("packing", _P), ("weights", _I), ("precision", _I), ("only", _I), ("fixed", _I),
    ("editable", _I), ("language", _I), ("exact", _I), ("library", _I),
    ("prefix", _S), ("without_comments", _I))
_measured_options = _structure(
    "hnbrdf_measured_options", ("max_bytes", _Z), ("merl_lookup", _I), ("merl_node", _I),
    ("merl_identify", _I), ("rgl_signed", _I), ("rgl_spectra", _I), ("utia_mode", _I),
    ("utia_scale", _D), ("utia_no_extrapolate", _I), ("read_hdf5", _P))
_flip_exposures = _structure(
    "hnbrdf_flip_exposures", ("start", _D), ("stop", _D), ("count", _I))
_custom = _structure("hnbrdf_measured_custom", ("name", _S), ("summary", _S), ("isotropic", _I),
                     ("eval", _eval_fn), ("release", _P), ("user", _P))
_fit_progress = _structure("hnbrdf_fit_progress", ("stage", _S), ("done", _D), ("loss", _D),
                           ("pairs_per_s", _D), ("seconds_left", _D), ("step", c.c_long))
_fit_options = _structure(
    "hnbrdf_fit_options", ("kind", _I), ("hidden", _I), ("layers", _I), ("latent", _I),
    ("latent_none", _I), ("encoding", _S), ("floor", _F), ("floor_none", _I), ("analytic", _I),
    ("materials", _P), ("search", _P), ("drawn", _P), ("worth", _P), ("steps", c.c_long),
    ("seconds", _D), ("batch", _I), ("pool", _I), ("memory", _Z), ("learning_rate", _F),
    ("loss", _I), ("schedule", _I), ("horizon_share", _F), ("horizon_none", _I),
    ("bright_share", _F), ("bright_none", _I),
    ("uniform_share", _F), ("uniform_none", _I), ("lift", _F), ("lift_none", _I),
    ("seed", c.c_uint64), ("threads", _I), ("progress", _fit_fn), ("progress_user", _P),
    ("freeze", _P), ("checkpoint", _S),
    ("resume", _I), ("ranks", _P))
_fit_times = _structure("hnbrdf_fit_times", *((name, _D) for name in (
    "drawing", "ggx", "encoding", "network", "update", "exchange", "waiting")))
_fit_report = _structure(
    "hnbrdf_fit_report", ("final_loss", _D), ("seconds", _D), ("pairs_per_s", _D),
    ("steps", c.c_long), ("stopped", _I), ("pairs", _D), ("ranks", _I), ("flops", _D),
    ("times", _fit_times), ("threads", _I), ("kept", _D), ("redrawn", _I), ("instructions", _S),
    ("set_backs", _I), ("rate", _D), ("best_step", c.c_long), ("ggx_alone", _I),
    ("left_alone", _I), ("worse", _I), ("best_loss", _D), ("ggx_loss", _D))
_comparison = _structure("hnbrdf_comparison", ("smape", _D), ("smape_analytic", _D), ("mae", _D),
                         ("mse", _D), ("pairs", _Z))

# The values of each enum, from 0 on; a word is the end of the name in small letters, with hyphens.
ENUMS = {
    "kind": ("HNBRDF_KIND_", "HYBRID NEURAL GGX"),
    "encoding": ("HNBRDF_ENCODING_",
                 "DIRECTIONS HALF_DIFFERENCE ANGLES_DIRECTED ANGLES ANGLES_ANISOTROPIC "
                 "ANGLES_AZIMUTHS"),
    "variant": ("HNBRDF_VARIANT_", "AUTO PLAIN SSE2 AVX2 AVX512 NEON AVX2_FUSED AVX512_FUSED "
                "NEON_FUSED"),
    "change": ("HNBRDF_CHANGE_", "PUT ADD REPLACE REMOVE RENAME LOBES"),
    "lobes": ("HNBRDF_LOBES_", "KEEP FIT PAPER GUESS"),
    "weights": ("HNBRDF_GLSL_", "CONSTANTS COLUMNS UNIFORM"),
    "precision": ("HNBRDF_GLSL_", "FLOAT HALF"),
    "only": ("HNBRDF_GLSL_", "EVERYTHING EVAL EVAL_SAMPLE"),
    "merl_lookup": ("HNBRDF_MERL_", "NEAREST TRILINEAR"),
    "merl_node": ("HNBRDF_MERL_", "CENTRE EDGE"),
    "utia_mode": ("HNBRDF_UTIA_", "DJB RAW SRGB"),
    "analytic": ("HNBRDF_FIT_", "FAITHFUL JOINT"),
    "loss": ("HNBRDF_FIT_", "LOG_TO_SMAPE LOG SMAPE"),
    "schedule": ("HNBRDF_FIT_", "COSINE LINEAR CONSTANT"),
    "sampler": ("HNBRDF_SAMPLER_", "UNIFORM COSINE GRID"),
}


def words_of(enumeration: str) -> list[str]:
    return ENUMS[enumeration][1].lower().replace("_", "-").split()


def value_of(enumeration: str, word: str) -> int:
    words = words_of(enumeration)
    if word not in words:
        raise ValueError(f"{enumeration} {word!r}: expected one of {', '.join(words)}")
    return words.index(word)
