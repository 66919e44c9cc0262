/* grid.h: a grid of models fitted to the same data, and their errors over directions and of
 * pictures: what `hnbrdf report accuracy` and `report images` are made of. */
#ifndef HNBRDF_REPORT_GRID_H
#define HNBRDF_REPORT_GRID_H

#include "hnbrdf/fit.h"
#include "report/flip.h"
#include "report/picture.h"
#include "report/watch.h"

#include <stdio.h>

enum { REPORT_SAMPLERS = HNBRDF_SAMPLER_GRID + 1, REPORT_NETS = 16, REPORT_LATENTS = 8 };

/* A material of a hybrid has kd, eta and alpha beside its latent code; a neural one has as many
 * more latent floats, so that both store equally much. */
enum { REPORT_ANALYTIC_NUMBERS = 8 };

/* Samples a pixel of the spheres of `report accuracy`; PSNR beyond the limit, equal pictures for
 * one, counts as the limit. */
enum { REPORT_IMAGE_SAMPLES = 32 };
#define REPORT_PSNR_LIMIT 120.0

/* How far the sphere of a material is from the measurement's, and what noise does to that. */
typedef struct report_picture {
    int done;
    double mae, mse, psnr, psnr_error, psnr_bias, peak_error; /* see hnbrdf_image_noise */
    double flip; /* of the mean of both renderings, noise and all */
} report_picture;

typedef enum report_form {
    REPORT_GGX = 0,
    REPORT_HYBRID, /* this library's: default encoding and floor */
    REPORT_PAPER,  /* the paper's: encoding directions, no floor, GGX trained jointly */
    REPORT_NEURAL, /* default encoding and floor, no analytic part */
    REPORT_FORMS
} report_form;

/* What the fit found of a material: see hnbrdf_fit_worth. */
typedef enum report_judged {
    REPORT_BETTER = 0, /* than GGX alone, or as good */
    REPORT_ALONE,      /* worse, and so left to GGX alone */
    REPORT_WORSE       /* worse, but the network cannot be turned off for it */
} report_judged;

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
    report_picture *pictures;   /* [materials], if pictures are made */
    unsigned char *judged;      /* [materials]: report_judged, of those with a network and GGX */
    double mean_psnr, mean_mae; /* over the materials */
    double mean_psnr_error;     /* standard error by noise of mean_psnr, of the peaks too */
    double mean_flip;
} report_entry;

typedef struct report_images report_images;

typedef struct report_data {
    hnbrdf_measured *const *items;
    int count;
} report_data;

/* Networks that were not fitted here. */
enum { REPORT_PUBLISHED, REPORT_NBRDF, REPORT_OUTSIDES };
/* Of an NBRDF network: 6 inputs, 21, 21, 3 outputs. */
enum { REPORT_NBRDF_NUMBERS = 675 };

typedef struct report_outside {
    int has;                       /* how many materials of the data */
    hnbrdf_comparison *errors;     /* [REPORT_SAMPLERS][materials]; 0 pairs: it lacks it */
    double smape[REPORT_SAMPLERS]; /* mean over those that it has */
} report_outside;

typedef struct report {
    const char *directory;
    const char *command_line;
    report_data data;
    report_watch watch;
    hnbrdf_error *error; /* gets the message of what fails below */
    report_entry *entries;
    int count;
    int nets[REPORT_NETS][2], net_count;
    int latents[REPORT_LATENTS], latent_count;
    int forms[REPORT_FORMS]; /* 1: in the grid */
    int sampler;             /* an hnbrdf_sampler: of the plots, the wins and the analytic part */
    int analytic;            /* an hnbrdf_fit_analytic: of the hybrids */
    long pairs, seed, steps, threads, pool;
    long image_size;       /* pixels a side of the spheres; 0: no pictures */
    report_light light;    /* of the spheres, and their samples a pixel */
    report_flip flip;      /* how FLIP looks at them */
    report_images *images; /* references, from the first entry on */
    /* [materials]: the fits of GGX alone, once the first entry is done */
    hnbrdf_material *ggx;
    hnbrdf_fit_search *search; /* [materials]: how they went; starts 0 where it is not known */
    hnbrdf_model *ggx_model;   /* of them, for the pictures; once the first entry is done */
    double budget;             /* seconds of training an entry; 0: `steps` */
    /* a folder of an earlier report whose models are taken; NULL: none */
    const char *from;
    const char *given; /* the file of the only model beside GGX alone; NULL: a grid */
    long rows;         /* materials whose spheres are shown */
    int resume;
    int paper;               /* 1: our figures beside the paper's */
    hnbrdf_model *published; /* the paper's networks, or NULL */
    report_data nbrdf;       /* networks of Neural-BRDF */
    report_outside outside[REPORT_OUTSIDES];
    const hnbrdf_communicator *ranks; /* processes that share the entries; NULL: this one alone */
} report;

/* ---- Files of the report's folder --------------------------------------------------------------
 * Those that return an hnbrdf_result leave the message of a failure in r->error; so do those that
 * return NULL. */

/* The file NAME in the report's folder; malloc'ed, NULL if that fails. */
char *report_path_in(const report *r, const char *name);
/* The report's folder and NAME in it. */
hnbrdf_result report_make_folders(const report *r, const char *name);
/* Writes the file NAME in the report's folder. */
hnbrdf_result report_write(const report *r, const char *name,
                           void (*write)(const report *r, FILE *file));
hnbrdf_result report_write_net(const report *r, const char *name, const int net[2],
                               void (*write)(const report *r, const int net[2], FILE *file));

/* ---- grid.c --------------------------------------------------------------------------- */

/* "ggx", "hybrid", "paper", "neural"; NULL for any other value. */
const char *report_form_name(report_form form);
/* Makes the entries: ggx first, then by net, latent size and form. */
hnbrdf_result report_make_entries(report *r);
void report_free_entries(report *r);
/* The entry of this form at a place of the grid, or NULL. latent is the hybrid's; ggx has
 * neither. */
const report_entry *report_find(const report *r, report_form form, const int net[2], int latent);
/* SMAPE of material m with the report's sampler. */
double report_error(const report *r, const report_entry *e, int m);
/* 1 if every entry is done. Until then nothing is said to be better than something else. */
int report_is_complete(const report *r);
/* 1 if the fit judges the materials of this form: a network and GGX. */
int report_is_judged(report_form form);
/* For how many materials a has the lower error; the higher PSNR. */
int report_wins(const report *r, const report_entry *a, const report_entry *b);
int report_image_wins(const report *r, const report_entry *a, const report_entry *b);
/* "models/NAME.SUFFIX" in the report's directory; malloc'ed, NULL if that fails. */
char *report_path(const report *r, const char *name, const char *suffix);
/* Material m of the data in a model that has all of them, whatever their order. */
const hnbrdf_material *report_material(const report *r, const hnbrdf_model *model, int m);

/* ---- grid_fit.c ------------------------------------------------------------------------------ */

/* Fits or reuses, saves and measures all entries; calls `finished` after each one, by rank 0 alone,
 * and stops when it fails. A watch that says stop ends it after the step. */
hnbrdf_result report_run(report *r,
                         hnbrdf_result (*finished)(const report *r, const report_entry *e));
/* The error of a watch that says stop. */
hnbrdf_result report_interrupted(const report *r);
/* A model that some other command made; one that lacks a material of the data is an error. */
hnbrdf_result report_load_model(const report *r, const char *path, hnbrdf_model **model);
/* Fits, reuses or takes all models and measures nothing; models is [entries]. */
hnbrdf_result report_make_models(report *r, hnbrdf_model **models);

/* ---- grid_ranks.c: by all ranks at the same time -------------------------------------------- */

/* 0 of 1 where the report is made by one process. */
int report_rank(const report *r);
int report_rank_count(const report *r);
/* The failure of any is one of all; *flag becomes the or of all. */
hnbrdf_result report_agree(const report *r, hnbrdf_result mine, int *flag);
/* The figures of an entry, of the rank that made it, to all. */
hnbrdf_result report_spread_entry(const report *r, int from, report_entry *e);

/* ---- grid_images.c: spheres, each rendered twice with half of the samples and a seed of its own,
 * so that what noise does is known ------------------------------------------------------------- */

/* Opens the light. */
hnbrdf_result report_images_open(report *r);
/* Renders the measurement of material m; ggx is the model of the first entry. */
hnbrdf_result report_images_reference(report *r, int m, const hnbrdf_model *ggx);
/* Fills e->pictures[m]. The mean of both renderings goes to *mean, unless that is NULL. */
hnbrdf_result report_images_measure(report *r, int m, report_entry *e, const hnbrdf_model *model,
                                    render_image *mean);
/* Puts the mean of both references into the first one and returns it; the second is no more. */
const render_image *report_images_mean_reference(report *r, int m);
void report_images_drop_reference(report *r, int m);
/* All materials of an entry in turn; before the first one that is measured the references are
 * rendered. */
hnbrdf_result report_images_entry(report *r, report_entry *e, const hnbrdf_model *model);
/* Fills the means over the materials that are done. */
void report_images_average(const report *r, report_entry *e);
void report_images_end(report *r);
/* All spheres of the materials that are not done; those of the picture rows are kept. Calls
 * `finished` after each material and stops when it fails. */
hnbrdf_result report_images_run(report *r, hnbrdf_model *const *models,
                                hnbrdf_result (*finished)(report *r));
/* The settings that figures depend on, in images.txt; the figures made with them, of images.csv.
 * *same: 1 if the file in the folder says what is asked for now. */
hnbrdf_result report_images_same_settings(const report *r, hnbrdf_model *const *models, int *same);
hnbrdf_result report_images_keep_settings(const report *r, hnbrdf_model *const *models);
hnbrdf_result report_images_read_figures(report *r);
/* 1 if every entry has its figures of material m. */
int report_images_is_done(const report *r, int m);

/* ---- grid_kept.c --------------------------------------------------------------------------- */

/* The figures of an entry that is measured go beside its model. */
hnbrdf_result report_keep_figures(const report *r, const report_entry *e,
                                  const hnbrdf_model *model);
/* 1 if there are figures of this very model, measured with the settings of this report, and the
 * entry has them now. */
int report_take_figures(const report *r, report_entry *e, const hnbrdf_model *model);

/* ---- grid_outside.c: networks that were not fitted here ------------------------------------- */

/* Measures those that are there. */
hnbrdf_result report_measure_outside(report *r);
/* SMAPE of GGX alone over the materials that it has; once the first entry is done. */
double report_ggx_beside(const report *r, const report_outside *o, int sampler);

/* ---- grid_paper.c: beside the paper ---------------------------------------------------------- */

/* "Data: ...", what they are of the paper's databases. */
void report_write_recognised(const report *r, FILE *file);
/* Markdown, a section. */
void report_write_paper(const report *r, FILE *file);

/* ---- grid_judged.c: which materials were left to GGX alone, and which are worse than it ------ */

void report_write_judged(const report *r, FILE *file);

/* ---- grid_tables.c, grid_plot.c, grid_ggx.c: into FILE, whatever is done so far -------- */

/* Everything of `report accuracy` into the report's folder. */
hnbrdf_result report_write_accuracy_files(const report *r);
void report_write_markdown(const report *r, FILE *file);
void report_write_accuracy(const report *r, FILE *file);
void report_write_materials(const report *r, FILE *file);
/* The fits of GGX alone, a row a material; their section of the Markdown; their plot. */
void report_write_ggx(const report *r, FILE *file);
void report_write_ggx_section(const report *r, FILE *file);
void report_write_ggx_plot(const report *r, FILE *file);
/* SVG: the error of every material, in the order of GGX's, for the models of one net: SMAPE;
 * PSNR. */
void report_write_plot(const report *r, const int net[2], FILE *file);
void report_write_psnr_plot(const report *r, const int net[2], FILE *file);
/* "| net |" and a column for every form and latent size. */
void report_write_form_header(const report *r, FILE *file);
const char *report_form_title(report_form form);
/* kind,net,encoding,latent */
void report_write_model_columns(const report_entry *e, FILE *file);
/* "Data: ...", a line. */
void report_write_data(const report *r, FILE *file);

/* ---- grid_image_tables.c ------------------------------------------------------------------- */

/* What PSNR is measured of; the paper's second table; FLIP likewise. */
void report_write_psnr_method(const report *r, FILE *file);
void report_write_psnr_table(const report *r, FILE *file);
void report_write_flip_table(const report *r, FILE *file);
/* Everything of `report images` but the picture rows into the report's folder. */
hnbrdf_result report_write_image_files(report *r);
/* images.csv, a row a material and model; images.md. */
void report_write_images_csv(const report *r, FILE *file);
void report_write_images_markdown(const report *r, FILE *file);

/* ---- grid_rows.c: picture rows ------------------------------------------------------------- */

enum { REPORT_ROWS_A_PAGE = 8 };
/* 1 if the spheres of material m are kept in pictures/. */
int report_rows_has(const report *r, int m);
/* Keeps a picture as pictures/MATERIAL-NAME.exr. */
hnbrdf_result report_rows_keep(const report *r, int m, const char *name, const render_image *image);
/* 1 if all of them that are to be kept are there; the reference is kept last. */
int report_rows_is_kept(const report *r, int m);
/* Composes images-1.png and so on, EXR beside, of what was kept; tells r->watch of each. */
hnbrdf_result report_rows_write(const report *r);

#endif
