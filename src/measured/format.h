/* format.h: what a format gives to measured.c. Formats know neither each other nor measured.c; each
 * describes itself in a row, a measured_reader, and formats.c lists the rows. */
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
    int is_signed;         /* negative values are kept: the caller clamps to +-HNBRDF_MAX_VALUE */
    const char *published; /* as hnbrdf_measured_published(); constant text or NULL */
    size_t bytes;          /* as hnbrdf_measured_bytes(); 0: the size of the file */
    char summary[256];
    /* Only of spectral data, else 0 and NULL: f at `count` wavelengths; likewise. */
    size_t wavelength_count;
    const float *wavelengths;
    int (*eval_spectrum)(const void *data, const double wi[3], const double wo[3], size_t count,
                         const float *nm, float *f);
} measured_body;

/* A file that has been read. The bytes are not needed after opening. */
typedef struct measured_file {
    const unsigned char *bytes;
    size_t size;
    const char *label; /* names the file in messages */
    const char *path;  /* to find the other files of the same material; NULL: read from memory */
} measured_file;

/* One row a format. */
typedef struct measured_reader {
    hnbrdf_measured_format_info info;
    /* What its files are known by, after "expected": "a MERL .binary (starts with ...)". */
    const char *expected;
    /* Does the content claim this format: then every further complaint is about it. NULL: no
     * files. */
    int (*recognise)(const measured_file *file);
    /* `options` has been checked and has its defaults filled in. */
    hnbrdf_result (*open)(const measured_file *file, const hnbrdf_measured_options *options,
                          measured_body *body, hnbrdf_error *error);
} measured_reader;

/* Row `index` of the table, from 0; NULL past the last. */
const measured_reader *hnbrdf_measured_reader_at(int index);
/* Checks `given` (or NULL) against the options of all formats, and fills in what a 0 stands for. */
hnbrdf_result hnbrdf_measured_settle(const hnbrdf_measured_options *given,
                                     hnbrdf_measured_options *settled, hnbrdf_error *error);
/* "expected a, b or c": all that can be opened. */
void hnbrdf_measured_expected(char *text, size_t size);

/* The caller has checked the description. On failure `user` is not released. */
hnbrdf_result hnbrdf_custom_open(const hnbrdf_measured_custom *custom, measured_body *body,
                                 hnbrdf_error *error);

/* index is in range. */
hnbrdf_result hnbrdf_builtin_open(int index, measured_body *body, hnbrdf_error *error);
hnbrdf_result hnbrdf_procedural_open(int number, measured_body *body, hnbrdf_error *error);

#endif
