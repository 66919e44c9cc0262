/* rgl_tables.c: the warp of an RGL material from its density, and the end of its memory. */
#include "measured/rgl.h"

#include <stdlib.h>

/* The integral along a row by the trapezoid rule, summed in double. */
static double sum_row(const float *density, size_t width)
{
    double along = 0.0;
    for (size_t x = 1; x < width; x++)
        along += ((double)density[x - 1] + (double)density[x]) / 2;
    return along;
}

static void fill_row(const float *density, size_t width, double total, rgl_node *nodes)
{
    double along = 0.0;
    for (size_t x = 0; x < width; x++) {
        if (x > 0)
            along += ((double)density[x - 1] + (double)density[x]) / 2;
        nodes[x] = (rgl_node){(float)((double)density[x] / total), (float)(along / total)};
    }
}

int hnbrdf_rgl_warp(rgl *material, size_t slice, const float *density)
{
    const size_t width = material->warp_width, height = material->warp_height;
    double total = 0.0, below = 0.0;
    for (size_t y = 1; y < height; y++)
        total +=
            (sum_row(density + (y - 1) * width, width) + sum_row(density + y * width, width)) / 2;
    if (!(total > 0.0))
        return 0;
    for (size_t y = 0; y < height; y++) {
        const float *from = density + y * width;
        const size_t row = slice * height + y;
        const double along = sum_row(from, width);
        if (y > 0)
            below += (sum_row(from - width, width) + along) / 2;
        fill_row(from, width, total, material->nodes + row * width);
        material->rows[row] = (rgl_row){(float)(along / total), (float)(below / total)};
    }
    return 1;
}

void hnbrdf_rgl_release(void *data)
{
    rgl *material = data;
    if (!material)
        return;
    free(material->phi);
    free(material->theta);
    free(material->ndf.values);
    free(material->sigma.values);
    free(material->nodes);
    free(material->rows);
    free(material->rgb);
    free(material->wavelengths);
    free(material->spectra);
    free(material);
}
