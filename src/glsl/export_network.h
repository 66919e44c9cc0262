/* export_network.h: the network of a scene as GLSL. */
#ifndef HNBRDF_GLSL_EXPORT_NETWORK_H
#define HNBRDF_GLSL_EXPORT_NETWORK_H

#include "glsl/export_scene.h"
#include "glsl/printer.h"

/* void hnbrdf_network(hnbrdf_material material_in, vec3 x_0, vec3 x_1, out vec3 c_net[, out vec3
 * g_net]), the latent code is in latent0, latent1, ... of the material. Only for kinds with a
 * network. */
void hnbrdf_put_network(hnbrdf_printer *out, const hnbrdf_scene *s);

/* The numbers s, m and b of the model (0, 1, 2) as an expression. */
void hnbrdf_put_constant(hnbrdf_printer *out, const hnbrdf_scene *s, int which);

/* The body of hnbrdf_network for HNBRDF_GLSL_UNIFORM, and what it needs before it. */
void hnbrdf_put_weights_block(hnbrdf_printer *out, const hnbrdf_scene *s);
void hnbrdf_put_loops(hnbrdf_printer *out, const hnbrdf_scene *s);

/* Input i of the first layer in the order of summation, as an expression. */
void hnbrdf_put_input(hnbrdf_printer *out, const hnbrdf_scene *s, int i);

#endif
