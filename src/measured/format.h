/* format.h: what a format gives to measured.c. Formats know neither each other nor measured.c. */
#ifndef HNBRDF_MEASURED_FORMAT_H
#define HNBRDF_MEASURED_FORMAT_H

#include "hnbrdf/measured.h"

/* One opened material. measured.c owns it: `release` frees `data` and allows NULL. */
typedef struct measured_body {
    void *data;
    /* f of two unit vectors with z > 0. Returns 0 where nothing was measured, f is then unused;
     * otherwise f may be negative, infinite or NaN: the caller clamps it to [0, HNBRDF_MAX_VALUE]. */
    int (*eval)(const void *data, const double wi[3], const double wo[3], double f[3]);
    void (*release)(void *data);
    int isotropic;
    char summary[256];
} measured_body;

/* Each reader: does the content claim this format (then every further complaint is about it), and
 * read it. `label` names the file in messages. The bytes are not needed afterwards. */
int hnbrdf_merl_recognise(const unsigned char *bytes, size_t size);
hnbrdf_result hnbrdf_merl_open(const unsigned char *bytes, size_t size, const char *label,
                               measured_body *body, hnbrdf_error *error);

int hnbrdf_rgl_recognise(const unsigned char *bytes, size_t size);
hnbrdf_result hnbrdf_rgl_open(const unsigned char *bytes, size_t size, const char *label,
                              measured_body *body, hnbrdf_error *error);

/* index is in range. */
hnbrdf_result hnbrdf_builtin_open(int index, measured_body *body, hnbrdf_error *error);

#endif
