/* sampling.h: noise of drawing directions in several ways, as `hnbrdf report sampling` tells it. */
#ifndef HNBRDF_REPORT_SAMPLING_H
#define HNBRDF_REPORT_SAMPLING_H

#include "report/picture.h"
#include "report/watch.h"

/* Ways to draw directions. The last one is what the others are compared with. */
typedef enum sampling_way {
    SAMPLING_COSINE = 0,
    SAMPLING_PAPER,     /* hnbrdf_lobes_paper() */
    SAMPLING_GUESS,     /* no lobes fitted */
    SAMPLING_FITTED,    /* hnbrdf_lobes_fit() */
    SAMPLING_TABULATED, /* render/tabulated.h; isotropic materials */
    SAMPLING_WAYS
} sampling_way;

enum { SAMPLING_COUNTS = 16, SAMPLING_STRIP_COUNTS = 2 };

/* "cosine", "paper", "guess", "fitted", "tabulated"; how it is called in plots. */
const char *sampling_name(sampling_way way);
const char *sampling_title(sampling_way way);

/* One way with one material; mse is 0 where the way does not exist. */
typedef struct sampling_run {
    /* Against the reference, over the pixels that the sphere covers. That of one sample a pixel
     * is the variance of the sampler, from as many renderings as the tables have samples; with
     * more, samples are stratified. */
    double mse[SAMPLING_COUNTS];
    double ns; /* processor time of one sample, everything included */
} sampling_run;

typedef struct sampling_subject {
    const hnbrdf_model *model;
    const char *name, *file;
    const hnbrdf_material *material;
    int done, has_strip;
    double level, covered; /* mean of the reference; its pixels, the covered share of each */
    sampling_run runs[SAMPLING_WAYS];
    /* Kept for the strips: the reference, and each way at strip_counts samples. */
    render_image reference, strips[SAMPLING_STRIP_COUNTS][SAMPLING_WAYS];
} sampling_subject;

typedef struct sampling_report {
    const char *directory, *command_line;
    report_light light; /* its spp: of the reference */
    render_environment environment;
    long size;
    int counts[SAMPLING_COUNTS], count_count; /* samples a pixel, ascending */
    /* of counts: that of the tables for stratified samples */
    int at;
    int strips[SAMPLING_STRIP_COUNTS]; /* of counts */
    sampling_subject *subjects;
    int count;
    report_watch watch;
    hnbrdf_error *error; /* gets the message of what fails below */
} sampling_report;

/* Renders everything of subject m. */
hnbrdf_result sampling_measure(const sampling_report *r, int m);

/* Error of a way with counts[k] samples a pixel over that of another; 0 where either is missing.
 * Mean over the subjects that are done, NAN without any; of those with alpha below `alpha`, 2 for
 * all. */
double sampling_ratio(const sampling_subject *s, int k, sampling_way way, sampling_way to);
double sampling_mean_ratio(const sampling_report *r, int k, sampling_way way, sampling_way to,
                           double alpha);
/* 1 / (variance times time) over that of the table, mean likewise. */
double sampling_mean_efficiency(const sampling_report *r, sampling_way way);

/* sampling.csv, sampling.md, sampling.svg. */
hnbrdf_result sampling_write(const sampling_report *r);
/* sampling-strips.exr and .png; tells r->watch of it. */
hnbrdf_result sampling_write_strips(const sampling_report *r);

#endif
