/* format.h: what a format gives to measured.c. Formats know neither each other nor measured.c. */
#ifndef HNBRDF_MEASURED_FORMAT_H
#define HNBRDF_MEASURED_FORMAT_H

#include "hnbrdf/measured.h"

/* One opened material. measured.c owns it: `release` frees `data` and allows NULL. */
typedef struct measured_body {
    void *data;
    /* f of two unit vectors with z > 0. Returns 0 where nothing was measured, f is then unused;
     * otherwise f may be negative, infinite or NaN: the caller clamps it to [0,
     * HNBRDF_MAX_VALUE]. */
    int (*eval)(const void *data, const double wi[3], const double wo[3], double f[3]);
    void (*release)(void *data);
    int isotropic;
    int is_signed; /* negative values are kept: the caller clamps to +-HNBRDF_MAX_VALUE */
    char summary[256];
    /* Only of spectral data, else 0 and NULL: f at `count` wavelengths; likewise. */
    size_t wavelength_count;
    const float *wavelengths;
    int (*eval_spectrum)(const void *data, const double wi[3], const double wo[3], size_t count,
                         const float *nm, float *f);
} measured_body;

/* Each reader: does the content claim this format (then every further complaint is about it), and
 * read it. `label` names the file in messages. The bytes are not needed afterwards. `options` is
 * never NULL, has been checked, and has its defaults filled in. */
int hnbrdf_merl_recognise(const unsigned char *bytes, size_t size);
hnbrdf_result hnbrdf_merl_open(const unsigned char *bytes, size_t size, const char *label,
                               const hnbrdf_measured_options *options, measured_body *body,
                               hnbrdf_error *error);

int hnbrdf_rgl_recognise(const unsigned char *bytes, size_t size);
hnbrdf_result hnbrdf_rgl_open(const unsigned char *bytes, size_t size, const char *label,
                              const hnbrdf_measured_options *options, measured_body *body,
                              hnbrdf_error *error);

/* A file without a header: recognised by its size, and as a failed one by a label that ends in
 * ".bin". */
int hnbrdf_utia_recognise(size_t size, const char *label);
hnbrdf_result hnbrdf_utia_open(const unsigned char *bytes, size_t size, const char *label,
                               const hnbrdf_measured_options *options, measured_body *body,
                               hnbrdf_error *error);

/* The caller has checked the description. On failure `user` is not released. */
hnbrdf_result hnbrdf_custom_open(const hnbrdf_measured_custom *custom, measured_body *body,
                                 hnbrdf_error *error);

/* index is in range. */
hnbrdf_result hnbrdf_builtin_open(int index, measured_body *body, hnbrdf_error *error);

#endif
