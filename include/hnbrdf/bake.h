/* bake.h: the smallest network that is good enough for the materials of one scene (libhnbrdf_bake).
 *
 * A network that a whole database shares is larger than a few of its materials need. Baking refits
 * a small one to just the materials that a scene uses: from their measurements, or from the model
 * itself as the teacher. Candidates get a short fit first, in order of their size; those that come
 * near the wish get a full one from several seeds. Errors are SMAPE against what was learned from.
 *
 * The same options, seed included, give the same model, bit by bit, on any number of threads, as
 * long as no time decides: with HNBRDF_BAKE_TIME, HNBRDF_BAKE_AUTO or `seconds` it does. */
#ifndef HNBRDF_BAKE_H
#define HNBRDF_BAKE_H

#include "hnbrdf/fit.h"
#include "hnbrdf/metrics.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is asked for. */
typedef enum hnbrdf_bake_wish {
    HNBRDF_BAKE_AUTO = 0, /* the network with the lowest product of error and time */
    HNBRDF_BAKE_ERROR,    /* the fewest multiplications with an error of at most max_error; where
                             GGX alone is within it, no network at all (kind ggx) */
    HNBRDF_BAKE_TIME,     /* the lowest error with at most max_ns an evaluation */
    HNBRDF_BAKE_SIZE,     /* the lowest error with at most max_multiplications */
    HNBRDF_BAKE_NET,      /* the network with `layers` hidden layers of `hidden` units */
    HNBRDF_BAKE_FRONT /* error against time: full fits of all networks that none beats in both after
                         short ones; picked as HNBRDF_BAKE_AUTO */
} hnbrdf_bake_wish;

/* Which error of several materials counts. */
typedef enum hnbrdf_bake_judge {
    HNBRDF_BAKE_MEAN = 0, /* their mean */
    HNBRDF_BAKE_WORST     /* the highest */
} hnbrdf_bake_judge;

/* Where kd, eta, alpha and rotation come from. The network never takes them over. */
typedef enum hnbrdf_bake_analytic {
    HNBRDF_BAKE_ANALYTIC_AUTO = 0, /* fitted to measurements; kept where the model is the teacher,
                                      unless it is neural and has none */
    HNBRDF_BAKE_ANALYTIC_KEEP,     /* the model's, edits included, to the last bit */
    HNBRDF_BAKE_ANALYTIC_FIT       /* a GGX fit to what is learned from */
} hnbrdf_bake_analytic;

/* A network that may be tried; hidden 0 is GGX alone. */
typedef struct hnbrdf_bake_size {
    int hidden, layers, latent; /* H and N in HxN, and l */
    /* as hnbrdf_model_multiplications() and hnbrdf_model_weight_count() have it */
    size_t multiplications, weights;
    /* an evaluation by hnbrdf_eval_batch(), one material, one thread of this machine; or what
     * hnbrdf_bake_options.time says */
    double ns;
    double half_ns; /* with the network in half precision; NaN where unknown, as in C */
    int encoding;   /* one more than its hnbrdf_encoding; 0: by the options or the data */
} hnbrdf_bake_size;

/* A model that was made: GGX alone, or by a short or a full fit. Errors are SMAPE. */
typedef struct hnbrdf_bake_row {
    hnbrdf_bake_size size;
    int full;        /* 1: trained to the full length, the best of several seeds; 1 for GGX too */
    long steps;      /* of the fit */
    uint64_t seed;   /* that gave this model */
    double seconds;  /* of the fit */
    double smape;    /* mean over the materials */
    double worst;    /* the highest of them */
    double analytic; /* mean of the analytic part alone */
    hnbrdf_encoding encoding;
    hnbrdf_comparison *errors; /* [material_count] */
    int half; /* 1: within max_ns in half precision alone; errors are of weights rounded to it */
} hnbrdf_bake_row;

/* Why a row was picked. */
typedef enum hnbrdf_bake_reason {
    HNBRDF_BAKE_GIVEN = 0,     /* it is the network asked for */
    HNBRDF_BAKE_GGX_IS_ENOUGH, /* GGX alone is within max_error */
    HNBRDF_BAKE_SMALLEST,      /* the fewest multiplications within max_error */
    HNBRDF_BAKE_MOST_ACCURATE, /* the lowest error within the limit; or of all, if none is within */
    HNBRDF_BAKE_FASTEST,       /* the least time: none is within max_ns */
    HNBRDF_BAKE_BALANCED       /* the lowest product of error and time */
} hnbrdf_bake_reason;

/* Whether everything was tried that should be. */
typedef enum hnbrdf_bake_end {
    HNBRDF_BAKE_COMPLETE = 0,
    HNBRDF_BAKE_OUT_OF_TIME, /* `seconds` were over */
    HNBRDF_BAKE_STOPPED      /* by the progress callback */
} hnbrdf_bake_end;

/* What was tried and what came of it. */
typedef struct hnbrdf_bake_report {
    hnbrdf_bake_wish wish;
    hnbrdf_bake_judge judge;
    hnbrdf_sampler sampler;     /* of the pairs that all errors are measured on */
    size_t pairs;               /* a material; short fits at most 20000 */
    uint64_t seed;              /* the first one */
    double max_error, max_ns;   /* what was asked for, as in hnbrdf_bake_options */
    size_t max_multiplications; /* likewise */
    int from_data;              /* 1: learned from and judged by measurements; 0: by the model */
    int kept;                   /* 1: the analytic part is the model's; 0: it was fitted */
    int material_count;
    const char **names;              /* [material_count] */
    hnbrdf_bake_size model;          /* what the given model costs */
    double model_smape, model_worst; /* its error; NaN unless there are measurements */
    hnbrdf_bake_row *rows;           /* in the order made; the first is GGX alone */
    int row_count;
    int picked; /* of rows: the model returned; -1 while there is none */
    hnbrdf_bake_reason reason;
    int met; /* 1: the picked row is what was asked for */
    hnbrdf_bake_end end;
    /* the judged error of the picked network with weights as an export in half precision has them;
     * NaN for GGX alone */
    double half_smape;
    const char *timed_on; /* as in hnbrdf_bake_options */
} hnbrdf_bake_report;

/* What it is at. */
typedef enum hnbrdf_bake_stage {
    HNBRDF_BAKE_TIMING = 0, /* how long candidates of every size take */
    HNBRDF_BAKE_GGX,        /* data are drawn and the analytic part is fitted */
    HNBRDF_BAKE_SHORT_FITS,
    HNBRDF_BAKE_FULL_FITS,
    HNBRDF_BAKE_LOBES /* of the model that was picked; it is no longer stopped */
} hnbrdf_bake_stage;

/* What the progress callback sees, some ten times a second, and after every row. */
typedef struct hnbrdf_bake_progress {
    hnbrdf_bake_stage stage;
    double done; /* share of this stage, 0 to 1; several stages of fits may follow each other */
    double loss; /* of a fit that is running; NaN while there is none */
    const hnbrdf_bake_size *first, *last; /* of the networks that are being fitted; or NULL */
    const hnbrdf_bake_report *report;     /* so far; its last row is new if new_row is 1 */
    int new_row;                          /* 1: the last row of the report is new */
} hnbrdf_bake_progress;

/* Return non-zero to stop: fits end after their step. Called by one thread at a time, not always
 * by the same one; rows are told by the thread that called hnbrdf_bake(). */
typedef int (*hnbrdf_bake_progress_fn)(void *user, const hnbrdf_bake_progress *progress);

/* Zero-initialise for defaults; 0 is the default everywhere. */
typedef struct hnbrdf_bake_options {
    hnbrdf_bake_wish wish;
    double max_error;           /* HNBRDF_BAKE_ERROR: above 0, at most 2 */
    double max_ns;              /* HNBRDF_BAKE_TIME: above 0 */
    size_t max_multiplications; /* HNBRDF_BAKE_SIZE: of the network, at least 1 */
    int hidden, layers;         /* HNBRDF_BAKE_NET: 1 to HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS */
    hnbrdf_bake_judge judge;
    /* Indices of the model's materials that are kept, in their new order, each once; NULL: all. */
    const int *materials;
    int material_count; /* ignored when materials is NULL */
    /* Measurements to learn from and be judged by; each material needs the one of its name, others
     * are ignored. NULL: the model is the teacher. */
    const hnbrdf_measured *const *data;
    int data_count;
    hnbrdf_bake_analytic analytic;
    /* l. 0: one less than there are materials, at most 8; HNBRDF_BAKE_ERROR tries half of that
     * too. latent_none 1: no latent code, enough for one material. */
    int latent;
    int latent_none; /* 1: l = 0 */
    /* A name as hnbrdf_encoding_name() has it; NULL: chosen by the data, as hnbrdf_fit() does. */
    const char *encoding;
    hnbrdf_sampler sampler; /* of the pairs that errors are measured on */
    size_t pairs;           /* of them, a material; 0: 200000 */
    long steps;             /* of a full fit; of a short one an eighth; 0: 32000 */
    int restarts;           /* seeds of a full fit, at most 32; 0: 4 */
    int pool;               /* pairs drawn a material for training, at least 64; 0: 131072, of
                               short fits 32768 */
    double seconds;         /* about the time for all fits; 0: by steps */
    uint64_t seed;          /* the first one of everything random */
    int threads;            /* at most 256; 0: one a processor */
    hnbrdf_bake_progress_fn progress;
    void *progress_user;
    /* Share the fits with other processes, all of which call this with the same options and have
     * the model and all data; NULL: alone. All get the same result; a clock or a callback of rank 0
     * or any other decides for all. `threads` and the callback may differ. */
    const hnbrdf_communicator *ranks;
    int all_encodings; /* 1: every network with each encoding that suits the data; no `encoding` */
    double max_ggx;    /* HNBRDF_BAKE_TIME: instead of max_ns, in times of GGX alone; or 0 */
    /* What an evaluation takes elsewhere, in ns, as on a GPU: of a model whose weights mean
     * nothing, its network in single or (half 1) half precision; NaN: not there. Called by the
     * thread that called hnbrdf_bake(). NULL: timed here. timed_on names it; it outlives the
     * report. */
    double (*time)(void *user, const hnbrdf_model *model, int half);
    void *time_user;
    /* what max_ns is measured on, for the report; NULL: this processor */
    const char *timed_on;
} hnbrdf_bake_options;

/* Bake the chosen materials of `model`, which stays as it is and need not outlive *baked. HNBRDF_OK
 * also where the wish could not be met: *baked is then the best of what was tried, and report->met
 * is 0. When the callback stops it or `seconds` are over, *baked is the best so far;
 * HNBRDF_ERROR_CANCELLED where nothing but GGX alone was made by then and that is not what was
 * asked for. A bad option is HNBRDF_ERROR_ARGUMENT. options may be NULL. report may be NULL; it is
 * filled on success only, and its memory is freed by hnbrdf_bake_report_free(). */
HNBRDF_EXPERIMENTAL hnbrdf_result hnbrdf_bake(const hnbrdf_model *model,
                                              const hnbrdf_bake_options *options,
                                              hnbrdf_model **baked, hnbrdf_bake_report *report,
                                              hnbrdf_error *error);

/* Frees what the report holds, not the report itself; it is zero afterwards. NULL is allowed. */
HNBRDF_EXPERIMENTAL void hnbrdf_bake_report_free(hnbrdf_bake_report *report);

/* "8x2", or "ggx". Returns text. */
HNBRDF_EXPERIMENTAL const char *hnbrdf_bake_size_name(const hnbrdf_bake_size *size, char text[16]);

/* The error that was judged: the mean or the highest of the row. */
HNBRDF_EXPERIMENTAL double hnbrdf_bake_judged(const hnbrdf_bake_report *report,
                                              const hnbrdf_bake_row *row);

#ifdef __cplusplus
}
#endif

#endif
