/* gradient.c: loss and gradient of one step, summed in fixed chunks, so that the number of threads
 * changes no bit. */
#include "fit/trainer.h"

#include <string.h>

static void chunk(void *context, int index, int worker)
{
    trainer *t = context;
    int each = t->tiles_per_step / FIT_CHUNKS;
    float *gradient = t->chunk_gradients + (size_t)index * t->layout.count;
    memset(gradient, 0, sizeof(float) * t->layout.count);
    double loss = 0.0;
    for (int k = index * each; k < (index + 1) * each; k++) {
        fit_tile tile = hnbrdf_fit_pool_view(&t->pool, t->tile_material[k], t->tile_index[k]);
        loss += t->kernel->network(&t->layout, t->parameters, t->derived, &tile,
                                   t->tile_material[k], t->mix,
                                   t->scratch + (size_t)worker * t->layout.scratch_count, gradient);
    }
    t->chunk_losses[index] = loss;
}

double hnbrdf_fit_step_gradient(trainer *t)
{
    t->kernel->derive(&t->layout, t->parameters, t->derived);
    hnbrdf_threads_run(t->workers, FIT_CHUNKS, chunk, t);
    double scale = 1.0 / (3.0 * FIT_TILE * t->tiles_per_step), loss = 0.0;
    memcpy(t->gradient, t->chunk_gradients, sizeof(float) * t->layout.count);
    for (int c = 1; c < FIT_CHUNKS; c++) {
        const float *g = t->chunk_gradients + (size_t)c * t->layout.count;
        for (size_t i = 0; i < t->layout.count; i++)
            t->gradient[i] += g[i];
    }
    for (size_t i = 0; i < t->layout.count; i++)
        t->gradient[i] *= (float)scale;
    if (t->options.freeze) /* a gradient of zero moves nothing */
        memset(t->gradient, 0, sizeof(float) * t->layout.network_count);
    for (int c = 0; c < FIT_CHUNKS; c++)
        loss += t->chunk_losses[c];
    return loss * scale;
}
