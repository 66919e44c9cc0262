/* export_input.c: the inputs of the network as GLSL. */
#include "glsl/export_network.h"

void hnbrdf_put_input(hnbrdf_printer *out, const hnbrdf_scene *s, int i)
{
    const int half = s->precision == HNBRDF_GLSL_HALF && s->desc->layers > 0;
    const int x = i - s->desc->latent;
    if (x < 0)
        hnbrdf_put(out, half ? "z_%d.%c" : "material_in.latent%d.%c", i / 4, "xyzw"[i % 4]);
    else
        hnbrdf_put(out, half ? "i_%d.%c" : "x_%d.%c", x / 3, "xyz"[x % 3]);
}
