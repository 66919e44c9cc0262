/* tabulated.h: a sampler that has a whole BRDF in a table, in the manner of Lawrence,
 * Rusinkiewicz and Ramamoorthi 2004: what sampling by a few lobes is compared with. For tools and
 * tests alone.
 *
 * For 90 views, an even step of the polar angle apart, f wi.z in 90 x 180 cells of the half
 * vector: theta_h = u^2 pi/2 as on MERL's grid, the azimuth relative to that of the view. 90 * 90
 * * 180 floats, 5.6 MB. Isotropic surfaces only. */
#ifndef HNBRDF_RENDER_TABULATED_H
#define HNBRDF_RENDER_TABULATED_H

#include "render/render.h"

typedef struct render_table render_table;

/* From surface->eval(), at four points of a cell. A hundredth of the samples is spread over all
 * cells, so that no direction is missed. */
hnbrdf_result render_table_create(const render_surface *surface, render_table **table,
                                  hnbrdf_error *error);
void render_table_free(render_table *table);
size_t render_table_bytes(void);

/* Lets the table choose the directions: in the pair of views around wo, by their distance. The
 * table is borrowed. */
void render_surface_tabulate(render_surface *surface, const render_table *table);

#endif
