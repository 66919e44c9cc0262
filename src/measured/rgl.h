/* rgl.h: one RGL material in memory, as rgl.c builds it and rgl_eval.c reads it. */
#ifndef HNBRDF_MEASURED_RGL_H
#define HNBRDF_MEASURED_RGL_H

#include <stddef.h>

/* Node (x, y) at values[y * width + x]; width, height >= 2. Width is the theta-like axis u_x,
 * height the phi-like one u_y; node x sits at u_x = x / (width - 1). */
typedef struct rgl_grid {
    size_t width, height;
    float *values;
} rgl_grid;

/* The density of visible normals as a warp table, one value a node: the density, and its integral
 * along the row up to here. Normalised so that each slice integrates to 1 in units of cells. */
typedef struct rgl_node {
    float density, below;
} rgl_node;

/* The integral of a whole row, and of all rows up to here. */
typedef struct rgl_row {
    float total, below;
} rgl_row;

/* A slice is one incident direction (phi_i, theta_i), number p * theta_count + t. */
typedef struct rgl {
    size_t phi_count, theta_count;
    double *phi, *theta; /* nodes, radians, strictly increasing */
    int isotropic;       /* phi_count <= 2: tables turn with wi */
    int reduction;       /* 1, 2 or 4: symmetry of an anisotropic sample */
    int needs_phi_i;     /* the azimuth of wi alone matters */
    rgl_grid ndf;        /* microfacet normal density D, 1/sr */
    rgl_grid sigma;      /* projected microfacet area */
    int jacobian;        /* 1: colours are to be multiplied by D / (4 sigma) */
    size_t warp_width, warp_height;
    rgl_node *nodes; /* [slice][y][x] */
    rgl_row *rows;   /* [slice][y] */
    size_t side;
    float *rgb; /* [slice][y][x][3], signed */
    size_t wavelength_count;
    float *wavelengths; /* nm, increasing; NULL without spectra */
    float *spectra;     /* [slice][y][x][wavelength], signed; NULL if not kept */
} rgl;

/* Fills the warp of one slice from its density, [y][x], not normalised; nodes and rows have their
 * memory. 0 where the density is 0 all over. */
int hnbrdf_rgl_warp(rgl *material, size_t slice, const float *density);
/* As measured_body.release. */
void hnbrdf_rgl_release(void *data);

/* As measured_body.eval: f per channel, signed. 0 where the normal is invisible from wi. */
int hnbrdf_rgl_eval(const void *data, const double wi[3], const double wo[3], double f[3]);
/* As measured_body.eval_spectrum; the spectra must have been kept. */
int hnbrdf_rgl_eval_spectrum(const void *data, const double wi[3], const double wo[3], size_t count,
                             const float *nm, float *f);

#endif
