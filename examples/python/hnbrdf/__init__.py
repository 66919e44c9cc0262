"""hnbrdf: hybrid neural-microfacet BRDFs with NumPy, over the shared libraries of libhnbrdf.

    import hnbrdf
    model = hnbrdf.Model.load("examples/models/rgl_32x2.safetensors")
    f = model.evaluate(wi, wo, "vch_silk_blue")         # [N, 3] and [N, 3] to [N, 3]

Directions are unit vectors in the frame of the surface (x tangent, z normal) that point away from
it: wi to the light, wo to the viewer. f is in 1/sr, linear RGB, without the cosine. Densities are
in 1/sr, angles in radians. include/hnbrdf/hnbrdf.h has the whole convention.

No copies: a float32 array [..., 3] is passed as it is where its last axis is contiguous and its
rows follow each other at one positive distance, as in a slice or in a field of a structured array.
All else (float64, broadcast, reversed) is copied first. Calls let other Python threads run; a model
may be used by many at once.

Errors are raised as hnbrdf.Error, with the one line of the library; what a reader converts is told
by warnings.warn(). The libraries are those in the folder HNBRDF_LIBRARY_PATH (environment, or
use_libraries()), in build/ of the checkout this file lies in, or where the system finds them.
"""
from .arrays import Array
from .fitting import Progress, compare, fit
from .layouts import material_dtype, sample_dtype
from .library import Error, Result, use_libraries
from .materials import Change, Material, assign, check, is_edited, material, mix, mix_at
from .measured import Measured
from .models import Description, Model, Samples

__all__ = ["Array", "Change", "Description", "Error", "Material", "Measured", "Model", "Progress",
           "Result", "Samples", "assign", "check", "compare", "fit", "is_edited", "material",
           "material_dtype", "mix", "mix_at", "sample_dtype", "use_libraries"]
