/* views.h: pixels of the small picture (pixels.h) as tiles, to fit a material in it. */
#ifndef HNBRDF_FIT_VIEWS_H
#define HNBRDF_FIT_VIEWS_H

#include "fit/pool.h"

/* One pixel: pairs to all lights and their weights; under each light it sends the sum of weights
 * times f. */
typedef struct fit_view {
    float tile[FIT_POOL_TILE];
    float lights[FIT_LIGHTS][FIT_TILE];
    float share; /* pixels that it stands for */
} fit_view;

enum { FIT_VIEWS_MOST = 512 };

typedef struct fit_views {
    int count;  /* at most FIT_VIEWS_MOST */
    int failed; /* 1: no memory; for the caller */
    fit_view *of;
    double ggx[FIT_LIGHTS]; /* squared error of GGX, summed over pixels and channels; above 0 */
} fit_views;

/* Of material `at` of the pool, which is encoded. 0 when memory is short. */
int hnbrdf_fit_views_make(fit_views *views, const fit_pool *pool, int at);

#endif
