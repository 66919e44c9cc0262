/* editing.h: how far an edited material is from what the edit means, as `hnbrdf report editing`
 * tells it. Members of procedural families (measured/families.h), whose truth after any edit is
 * known, are fitted together; then each is edited through the public functions and compared. */
#ifndef HNBRDF_REPORT_EDITING_H
#define HNBRDF_REPORT_EDITING_H

#include "hnbrdf/fit.h"
#include "measured/families.h"
#include "report/spheres.h"

/* ---- Edits: editing_edits.c ------------------------------------------------------------------ */

typedef enum editing_kind {
    EDITING_ALPHA = 0,  /* every roughness times the factor; times 1: no edit at all */
    EDITING_ETA,        /* reflectance at normal incidence times the factor */
    EDITING_KD,         /* diffuse part times the factor */
    EDITING_COLOUR,     /* by a ratio per channel: the diffuse part, or else the reflectance */
    EDITING_ANISOTROPY, /* alpha_x times the factor, alpha_y divided by it */
    EDITING_ROTATION,   /* of the tangent frame, by so many radians */
    EDITING_KINDS
} editing_kind;

typedef struct editing_edit {
    editing_kind kind;
    double factor;
} editing_edit;

extern const editing_edit editing_edits[];
extern const int editing_edit_count;

/* "alpha", "eta", "kd", "colour", "anisotropy", "rotation". */
const char *editing_kind_name(editing_kind kind);
/* "alpha x 0.5". */
void editing_edit_name(const editing_edit *edit, char *text, size_t size);
/* 1 if the edit makes sense for the family. */
int editing_makes_sense(const editing_edit *edit, int family);
/* What it means for the truth; 0 if a roughness leaves [1e-4, 1]. */
int editing_edit_truth(const editing_edit *edit, int family, hnbrdf_family_parameters *parameters);
/* The same edit of a model's material, by hnbrdf_material_set(). What leaves its range stops at its
 * end, as a slider does: *stopped is then 1. */
hnbrdf_result editing_edit_material(const editing_edit *edit, int family, hnbrdf_material *material,
                                    int *stopped, hnbrdf_error *error);

/* ---- Cases ----------------------------------------------------------------------------------- */

/* What is compared with the truth. */
typedef enum editing_way {
    EDITING_UNEDITED = 0, /* the fitted material as it was */
    EDITING_EDITED,
    EDITING_GGX,    /* the edited material's analytic part alone */
    EDITING_FROZEN, /* a fit of the network, frozen, to the truth: the best that it could do */
    EDITING_WAYS
} editing_way;

/* "unedited", "edited", "ggx", "frozen"; how it is called in tables. */
const char *editing_way_name(editing_way way);
const char *editing_way_title(editing_way way);

enum { EDITING_ALPHAS = 3 };
extern const double editing_alphas[EDITING_ALPHAS];                          /* of the members */
void editing_member_name(int family, double alpha, char *text, size_t size); /* "film-0.08" */

/* One edit of one member. */
typedef struct editing_case {
    int edit; /* of editing_edits */
    int stopped;
    hnbrdf_measured *truth;
    hnbrdf_material materials[EDITING_WAYS]; /* that of EDITING_GGX is the edited one */
    double smape[EDITING_WAYS], psnr[EDITING_WAYS];
} editing_case;

typedef struct editing_member {
    int family, model; /* of the families; of the report's models */
    double alpha;
    char name[48];
    int done;
    editing_case *cases;
    int count;
} editing_member;

typedef struct editing_model {
    char name[64];
    hnbrdf_model *model;
    long steps; /* 0: it was given */
    double seconds, loss;
} editing_model;

/* ---- Mixtures: editing_mix.c ----------------------------------------------------------------- */

/* Half way between two members of a family, against the member half way. */
typedef struct editing_half {
    int family, model;
    double smape, ggx, frozen;
} editing_half;

/* One model's pairs: how many mixtures have an albedo between those of their ends. */
typedef struct editing_pairs {
    int model, pairs, all; /* all: pairs of which every mixture does */
    int mixtures, within;
    struct editing_mixture *list; /* [mixtures] */
} editing_pairs;

enum { EDITING_STEPS = 3 }; /* t = 1/4, 1/2, 3/4 */
typedef struct editing_mixture {
    int ends[2]; /* materials of the model */
    double t;
    /* The largest factor by which a directional albedo is beyond the ends', over views and
     * channels; at most 1 within. */
    double beyond;
    int channel; /* where */
} editing_mixture;
#define EDITING_WIDENED 1.1 /* within: beyond by no more */

/* ---- The report ------------------------------------------------------------------------------ */

enum { EDITING_MODELS = 2 };

typedef struct editing_report {
    /* To fill in. */
    const char *directory; /* NULL: the models that are fitted are not kept */
    const char *command_line;
    int *families;             /* [family] 1: in the report; NULL: all */
    const hnbrdf_model *given; /* measured instead of a fit; NULL: none */
    const char *given_name;
    int net[2];
    int alone; /* 1: the members are fitted without the built-in materials */
    long steps, frozen_steps, pool, pairs, seed, threads;
    int sampler;        /* an hnbrdf_sampler */
    long image_size;    /* pixels a side of the spheres; 0: none */
    long sheet_size;    /* of those on the sheets */
    report_light light; /* of the spheres */
    report_watch watch;
    hnbrdf_error *error; /* gets the message of what fails below */

    /* Made by the functions below. */
    editing_model models[EDITING_MODELS];
    int model_count;
    editing_member *members;
    int count;
    editing_half *halves;
    int half_count;
    editing_pairs pair_sets[EDITING_MODELS];
    int pair_set_count;
    report_spheres spheres;
    double done, current, total; /* work: finished, under way, all; any unit */
    const char *detail;
} editing_report;

/* Fits the models, or takes the given one, and makes the cases of its members. */
hnbrdf_result editing_begin(editing_report *r);
/* The frozen fits, errors and spheres of member m. */
hnbrdf_result editing_measure(editing_report *r, int m);
/* Both measures of mixtures, in the end. */
hnbrdf_result editing_measure_mixtures(editing_report *r);
void editing_free(editing_report *r);

/* For the pieces: the error of a watch that says stop; progress within the current work; a fit that
 * shows its progress as r->detail, of data that are not all of one file. */
hnbrdf_result editing_interrupted(const editing_report *r);
void editing_show(const editing_report *r, double share);
hnbrdf_result editing_fit(editing_report *r, hnbrdf_measured *const *data, int count,
                          const hnbrdf_fit_options *options, hnbrdf_model **model,
                          hnbrdf_fit_report *made);
/* A model's network frozen and fitted to these; materials is [count]. */
hnbrdf_result editing_fit_frozen(editing_report *r, int model, hnbrdf_measured *const *data,
                                 int count, hnbrdf_material *materials);

/* ---- Results: editing_figures.c, editing_tables.c, editing_plot.c, editing_sheet.c ----------- */

/* A mean over the members that are done: of a family, or over families (-1), each of which counts
 * as much; NAN without any. psnr: 1 for PSNR, 0 for SMAPE. *members may be NULL. */
double editing_mean(const editing_report *r, int family, int edit, editing_way way, int psnr,
                    int *members);
/* Mean over the halves; NAN without any. */
double editing_mean_half(const editing_report *r, int model);

/* editing.csv, mixtures.csv, report.md, editing.svg: whatever is done so far. */
hnbrdf_result editing_write(const editing_report *r);
void editing_write_plot(const void *report, FILE *file);
/* editing-alpha.exr, editing-others.exr and .png beside; tells r->watch of them. */
hnbrdf_result editing_write_sheets(editing_report *r);

#endif
