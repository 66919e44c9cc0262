/* report.h: what the parts of `hnbrdf report accuracy` share: the grid of entries and their results. */
#ifndef HNBRDF_CLI_REPORT_H
#define HNBRDF_CLI_REPORT_H

#include "cli/cli.h"
#include "hnbrdf/fit.h"
#include "hnbrdf/metrics.h"

enum { REPORT_SAMPLERS = HNBRDF_SAMPLER_GRID + 1, REPORT_NETS = 16, REPORT_LATENTS = 8 };

/* A material of a hybrid has kd, eta and alpha beside its latent code; a neural one has as many more
 * latent floats, so that both store equally much. */
enum { REPORT_ANALYTIC_NUMBERS = 8 };

/* Samples a pixel of the spheres; PSNR beyond the limit, equal pictures for one, counts as the limit.
 */
enum { REPORT_IMAGE_SAMPLES = 32 };
#define REPORT_PSNR_LIMIT 120.0

typedef enum report_form {
    REPORT_GGX = 0,
    REPORT_HYBRID, /* this library's: default encoding and floor */
    REPORT_PAPER,  /* the paper's: encoding directions, no floor, GGX trained jointly */
    REPORT_NEURAL, /* default encoding and floor, no analytic part */
    REPORT_FORMS
} report_form;

/* One model of the grid and, once done, its errors. */
typedef struct report_entry {
    char name[48]; /* "hybrid-32x2-l4": of its file in models/ */
    report_form form;
    int net[2], latent; /* 0 for ggx */
    int done;
    hnbrdf_kind kind;
    hnbrdf_encoding encoding;
    float floor;
    long steps;
    double seconds, pairs_per_s; /* of the fit */
    size_t weights, mults;
    hnbrdf_comparison *errors; /* [REPORT_SAMPLERS][materials] */
    hnbrdf_comparison mean[REPORT_SAMPLERS];
    double *psnr, mean_psnr; /* [materials], dB, if pictures are made */
} report_entry;

typedef struct report_images report_images;

typedef struct report {
    const char *directory;
    const char *command_line;
    cli_data data;
    report_entry *entries;
    int count;
    int nets[REPORT_NETS][2], net_count;
    int latents[REPORT_LATENTS], latent_count;
    int forms[REPORT_FORMS]; /* 1: in the grid */
    int sampler;             /* an hnbrdf_sampler: of the plots, the wins and the analytic part */
    int analytic;            /* an hnbrdf_fit_analytic: of the hybrids */
    long pairs, seed, steps, threads, pool;
    long image_size;           /* pixels a side of the spheres; 0: no pictures */
    report_images *images;     /* references, from the first entry on */
    hnbrdf_material *ggx;      /* [materials]: the fits of GGX alone, once the first entry is done */
    hnbrdf_fit_search *search; /* [materials]: how they went; starts 0 where it is not known */
    double budget;             /* seconds of training an entry; 0: `steps` */
    int resume;
} report;

/* ---- report_grid.c ------------------------------------------------------------------------------- */

/* "ggx", "hybrid", "paper", "neural"; NULL for any other value. */
const char *report_form_name(report_form form);
/* Makes the entries: ggx first, then by net, latent size and form. 0, or CLI_FAILURE after a message.
 */
int report_make_entries(report *r);
void report_free_entries(report *r);
/* The entry of this form at a place of the grid, or NULL. latent is the hybrid's; ggx has neither. */
const report_entry *report_find(const report *r, report_form form, const int net[2], int latent);
/* SMAPE of material m with the report's sampler. */
double report_error(const report *r, const report_entry *e, int m);
/* For how many materials a has the lower error; the higher PSNR. */
int report_wins(const report *r, const report_entry *a, const report_entry *b);
int report_image_wins(const report *r, const report_entry *a, const report_entry *b);
/* "models/NAME.SUFFIX" in the report's directory; malloc'ed, NULL after a message. */
char *report_path(const report *r, const char *name, const char *suffix);

/* ---- report_fit.c -------------------------------------------------------------------------------- */

/* Fits or reuses, saves and measures all entries; calls `finished` after each one and stops when it
 * does not return 0. Ctrl-C ends it after the step. 0, or CLI_FAILURE after a message. */
int report_run(report *r, int (*finished)(const report *r, const report_entry *e));

/* ---- report_images.c -----------------------------------------------------------------------------
 */

/* Renders the references; ggx is the model of the first entry. Each: 0, or CLI_FAILURE after a message.
 */
int report_images_begin(report *r, const hnbrdf_model *ggx);
/* Fills psnr and mean_psnr. */
int report_images_measure(report *r, report_entry *e, const hnbrdf_model *model);
void report_images_end(report *r);

/* ---- report_tables.c, report_plot.c, report_ggx.c: into FILE, whatever is done so far
 * ----------------------------
 */

void report_write_markdown(const report *r, FILE *file);
void report_write_accuracy(const report *r, FILE *file);
void report_write_materials(const report *r, FILE *file);
/* The fits of GGX alone, a row a material; their section of the Markdown; their plot. */
void report_write_ggx(const report *r, FILE *file);
void report_write_ggx_section(const report *r, FILE *file);
void report_write_ggx_plot(const report *r, FILE *file);
/* SVG: the error of every material, in the order of GGX's, for the models of one net. */
void report_write_plot(const report *r, const int net[2], FILE *file);

#endif
