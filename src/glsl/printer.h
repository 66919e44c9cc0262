/* printer.h: what the files of the exporter print with. */
#ifndef HNBRDF_GLSL_PRINTER_H
#define HNBRDF_GLSL_PRINTER_H

#include "base/printer.h"

/* vec2, vec3 or vec4 of the first `given` values, then zeros. */
void hnbrdf_put_vector(hnbrdf_printer *out, int size, const float *values, int given);

#endif
