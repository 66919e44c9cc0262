/* export_evaluate.h: the functions a shader calls: evaluate, its analytic part alone, sample,
 * pdf. */
#ifndef HNBRDF_GLSL_EXPORT_EVALUATE_H
#define HNBRDF_GLSL_EXPORT_EVALUATE_H

#include "glsl/export_scene.h"
#include "glsl/printer.h"

/* hnbrdf_scene_pair, hnbrdf_analytic, hnbrdf_eval and, unless left out, hnbrdf_eval_analytic,
 * hnbrdf_pdf, hnbrdf_sample; hnbrdf_eval_world and so on; for a fixed scene hnbrdf_eval_NAME(wi,
 * wo) of every material. After the network. */
void hnbrdf_put_evaluate(hnbrdf_printer *out, const hnbrdf_scene *s);

#endif
