/* vector.c: vectors of numbers as literals. */
#include "glsl/printer.h"

void hnbrdf_put_vector(hnbrdf_printer *out, int size, const float *values, int given)
{
    hnbrdf_put(out, "vec%d(", size);
    for (int i = 0; i < size; i++) {
        hnbrdf_put_bytes(out, ", ", i > 0 ? 2 : 0);
        hnbrdf_put_float(out, i < given ? values[i] : 0.0f);
    }
    hnbrdf_put(out, ")");
}
