/* report.h: what the parts of `hnbrdf report` share: the grid of entries and their results. */
#ifndef HNBRDF_CLI_REPORT_H
#define HNBRDF_CLI_REPORT_H

#include "cli/picture.h"
#include "hnbrdf/fit.h"

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
} report_picture;

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
    report_picture *pictures;   /* [materials], if pictures are made */
    double mean_psnr, mean_mae; /* over the materials */
    double mean_psnr_error;     /* standard error by noise of mean_psnr, of the peaks too */
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
    long image_size;       /* pixels a side of the spheres; 0: no pictures */
    picture_options light; /* of the spheres, and their samples a pixel */
    report_images *images; /* references, from the first entry on */
    /* [materials]: the fits of GGX alone, once the first entry is done */
    hnbrdf_material *ggx;
    hnbrdf_fit_search *search; /* [materials]: how they went; starts 0 where it is not known */
    double budget;             /* seconds of training an entry; 0: `steps` */
    /* a folder of an earlier report whose models are taken; NULL: none */
    const char *from;
    const char *given; /* the file of the only model beside GGX alone; NULL: a grid */
    long rows;         /* materials whose spheres are shown */
    int resume;
} report;

/* `hnbrdf report images`; argv[1] is "images". */
int cmd_report_images(int argc, char **argv);
/* `hnbrdf report sampling`; argv[1] is "sampling". */
int cmd_report_sampling(int argc, char **argv);

/* ---- report_options.c: what the reports read and write alike. Those that return -1 to go on
 * return an exit code after a message otherwise, as cli_parse() does.
 * ----------------------------------------------------- */

int report_read_nets(const cli_command *command, const char *list, report *r);
int report_read_latents(const cli_command *command, const char *list, report *r);
int report_read_models(const cli_command *command, const char *list, report *r);
/* The command as it was typed, before cli_parse() moves its arguments about; malloc'ed, NULL when
 * memory is short. */
char *report_join(int argc, char **argv);
/* The file NAME in the report's folder; malloc'ed, NULL after a message. */
char *report_path_in(const report *r, const char *name);
/* The report's folder and NAME in it. 0, or CLI_FAILURE after a message. */
int report_make_folders(const report *r, const char *name);
/* Writes the file NAME in the report's folder. Likewise. */
int report_write(const report *r, const char *name, void (*write)(const report *r, FILE *file));
int report_write_net(const report *r, const char *name, const int net[2],
                     void (*write)(const report *r, const int net[2], FILE *file));

/* ---- report_grid.c --------------------------------------------------------------------------- */

/* "ggx", "hybrid", "paper", "neural"; NULL for any other value. */
const char *report_form_name(report_form form);
/* Makes the entries: ggx first, then by net, latent size and form. 0, or CLI_FAILURE after a
 * message. */
int report_make_entries(report *r);
void report_free_entries(report *r);
/* The entry of this form at a place of the grid, or NULL. latent is the hybrid's; ggx has
 * neither. */
const report_entry *report_find(const report *r, report_form form, const int net[2], int latent);
/* SMAPE of material m with the report's sampler. */
double report_error(const report *r, const report_entry *e, int m);
/* For how many materials a has the lower error; the higher PSNR. */
int report_wins(const report *r, const report_entry *a, const report_entry *b);
int report_image_wins(const report *r, const report_entry *a, const report_entry *b);
/* "models/NAME.SUFFIX" in the report's directory; malloc'ed, NULL after a message. */
char *report_path(const report *r, const char *name, const char *suffix);
/* Material m of the data in a model that has all of them, whatever their order. */
const hnbrdf_material *report_material(const report *r, const hnbrdf_model *model, int m);

/* ---- report_fit.c ---------------------------------------------------------------------------- */

/* Fits or reuses, saves and measures all entries; calls `finished` after each one and stops when it
 * does not return 0. Ctrl-C ends it after the step. 0, or CLI_FAILURE after a message. */
int report_run(report *r, int (*finished)(const report *r, const report_entry *e));
/* A model that some other command made; one that lacks a material of the data is an error.
 * Likewise. */
int report_load_model(const report *r, const char *path, hnbrdf_model **model);
/* Fits, reuses or takes all models and measures nothing; models is [entries]. Likewise. */
int report_make_models(report *r, hnbrdf_model **models);
/* Between both, Ctrl-C and SIGTERM only make report_interrupted() say 1. */
void report_catch_interrupts(int on);
int report_interrupted(void);

/* ---- report_images.c: spheres, each rendered twice with half of the samples and a seed of its
 * own, so that what noise does is known. Each: 0, or CLI_FAILURE after a message.
 * --------------------------------------- */

/* Opens the light. */
int report_images_open(report *r);
/* Renders the measurement of material m; ggx is the model of the first entry. */
int report_images_reference(report *r, int m, const hnbrdf_model *ggx);
/* Fills e->pictures[m]. The mean of both renderings goes to *mean, unless that is NULL. */
int report_images_measure(report *r, int m, report_entry *e, const hnbrdf_model *model,
                          render_image *mean);
/* Puts the mean of both references into the first one and returns it; the second is no more. */
const render_image *report_images_mean_reference(report *r, int m);
void report_images_drop_reference(report *r, int m);
/* All materials of an entry in turn; the first entry renders the references before. */
int report_images_entry(report *r, report_entry *e, const hnbrdf_model *model);
/* Fills the means over the materials that are done. */
void report_images_average(const report *r, report_entry *e);
void report_images_end(report *r);
/* Shown while spheres are rendered, and asked whether to stop. */
void report_images_watch(report *r, picture_progress *progress);

/* ---- report_tables.c, report_plot.c, report_ggx.c: into FILE, whatever is done so far -------- */

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

/* ---- report_image_tables.c ------------------------------------------------------------------- */

/* What PSNR is measured of; the paper's second table; the paper's own figures of it. */
void report_write_psnr_method(const report *r, FILE *file);
void report_write_psnr_table(const report *r, FILE *file);
void report_write_papers_psnr(FILE *file);
/* images.csv, a row a material and model; images.md. */
void report_write_images_csv(const report *r, FILE *file);
void report_write_images_markdown(const report *r, FILE *file);

/* ---- report_rows.c: picture rows ------------------------------------------------------------- */

enum { REPORT_ROWS_A_PAGE = 8 };
/* 1 if the spheres of material m are kept in pictures/. */
int report_rows_has(const report *r, int m);
/* Keeps a picture as pictures/MATERIAL-NAME.exr. */
int report_rows_keep(const report *r, int m, const char *name, const render_image *image);
/* 1 if all of them that are to be kept are there; the reference is kept last. */
int report_rows_is_kept(const report *r, int m);
/* Composes images-1.png and so on, EXR beside, of what was kept. */
int report_rows_write(const report *r);

#endif
