/* fit.h: fit a model to measured BRDFs (libhnbrdf_fit).
 *
 * First every material gets a GGX fit of its own (kd, eta, alpha; several starts). For a hybrid
 * that analytic part is then kept as it is (faithful), or trained on with the network, and the
 * shared network and the latent codes learn what is missing. The result depends on the data, the
 * options and the seed only, never on the number of threads. The tangent frame of an anisotropic
 * material is found too: x is where its GGX lobe is narrower (alpha[0] <= alpha[1], unless they
 * are trained on), along the grooves of a brushed metal.
 *
 * Data. Directions without a valid measurement are left out; a material where fewer than 1 % of the
 * directions drawn have one is refused. Negative values count as 0, values above 1e15 as 1e15. Both
 * losses grow slowly or not at all where the error is large, so a few wild values have little
 * influence. SMAPE has 1e-4 added to its denominator, the logarithm 1e-3 to its argument: values
 * far below that are matched to about 1e-4 1/sr, not in proportion to themselves. hnbrdf_fit_drawn
 * says how much of the data these rules concern.
 *
 * Divergence. Training is judged 25, 50 and 100 steps after it starts, and at every 200th step, by
 * its loss over a fixed sample of the training pairs. It counts as diverged if a number is no
 * longer finite, or if the loss exceeds both that of the untrained start and twice the best plus
 * 0.1. It also does if more than an eighth of a layer's units (at least 4, or all) died since the
 * best state, unless the loss is at most 0.01. It is then set back to the
 * best state, and moments and warm-up start anew at 0.3 times the rate. So a rate that is 100
 * times too large costs a few hundred steps. The report says how often that happened and what the
 * rate was at the end. The last state is returned, unless an earlier one was better by more than
 * 5 % plus 0.001: smaller differences are within the error of such a sample. A hybrid is never
 * worse
 * than GGX alone by more than that: where no state was better, the network returned leaves GGX as
 * it is. Every number in a model is finite.
 *
 * On a frozen network a material has only its latent code to find, and kd, eta and alpha where
 * they are joint. That is a method of Levenberg and Marquardt instead of Adam: from the 16 codes of
 * known materials that fit best, each on 2048 pairs; from 40 % of the steps on the best four, on
 * 8192; from 70 % on the best one, on 16384. From 40 % on it also makes the errors smaller that a
 * small picture under three suns shows. In the end the code taken is the one with the least loss of
 * those that make none of these pictures worse than GGX alone. Batch, learning rate and schedule
 * are not used. A joint analytic part is held near GGX: the more its SMAPE alone is above that of
 * the GGX fit, the more it costs; about 1.03 times is what comes of it. */
#ifndef HNBRDF_FIT_H
#define HNBRDF_FIT_H

#include "hnbrdf/measured.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How kd, eta and alpha are found. */
typedef enum hnbrdf_fit_analytic {
    HNBRDF_FIT_FAITHFUL = 0, /* GGX first, then frozen: kd, eta, alpha stay those of the GGX fit */
    HNBRDF_FIT_JOINT         /* GGX first, then trained together with the network */
} hnbrdf_fit_analytic;

/* What is minimised, per channel. SMAPE judges dark directions and highlights alike but is flat far
 * from the data; the logarithm leads there. */
typedef enum hnbrdf_fit_loss {
    HNBRDF_FIT_LOG_TO_SMAPE =
        0,           /* |ln(f + 1e-3) - ln(F + 1e-3)|, turning into SMAPE between 30 and 70 % */
    HNBRDF_FIT_LOG,  /* the first all along */
    HNBRDF_FIT_SMAPE /* the second all along */
} hnbrdf_fit_loss;

/* The learning rate from its peak to the end, after 100 steps of warm-up. */
typedef enum hnbrdf_fit_schedule {
    HNBRDF_FIT_COSINE = 0, /* half a cosine down to 0.01 % */
    HNBRDF_FIT_LINEAR,     /* a line down to 0.01 % */
    HNBRDF_FIT_CONSTANT
} hnbrdf_fit_schedule;

/* What the progress callback sees, ten times a second and every 100 steps. */
typedef struct hnbrdf_fit_progress {
    const char *stage;   /* "sampling", "ggx", "network" or "lobes" (those of the materials) */
    double done;         /* share of this stage, 0 to 1 */
    double loss;         /* running mean of the training loss; NaN while there is none */
    double pairs_per_s;  /* direction pairs trained on per second in this stage */
    double seconds_left; /* estimate for this stage; NaN while there is none */
    long step;           /* of the network, from 0 on */
} hnbrdf_fit_progress;

/* Return non-zero to stop: training ends after the step and the model so far is returned. Before
 * the network's first step there is none: a new fit then returns HNBRDF_ERROR_CANCELLED. */
typedef int (*hnbrdf_fit_progress_fn)(void *user, const hnbrdf_fit_progress *progress);

/* What the GGX fit of one material found. Its loss, 0.7 SMAPE + 0.3 |ln(f + 1e-3) - ln(F + 1e-3)|
 * over the training pairs, has several minima: every start is followed a little, the three best
 * ones to the end. Two that end alike speak for the global minimum. */
typedef struct hnbrdf_fit_search {
    int starts;            /* 0: no GGX fit was made */
    double best, second;   /* losses at the end of the best two; infinite if there is no second */
    float second_alpha[2]; /* where the second best ended */
} hnbrdf_fit_search;

/* What was drawn of one material. */
typedef struct hnbrdf_fit_drawn {
    double valid;   /* share of the directions drawn that have a valid measurement */
    double dark;    /* share of the values, all channels, below 1e-4 1/sr: nearly 0 to the loss */
    double cut;     /* share of the values above 1e15 1/sr, more than a BRDF has: taken as 1e15 */
    double largest; /* value */
} hnbrdf_fit_drawn;

/* One fit made by several processes, called ranks, for data that outgrow a machine. All of them
 * call hnbrdf_fit() with the same options, and get the same model and report, with the bits that
 * one process gives. The library knows no MPI: these callbacks are all that it asks of one. They
 * are called by the thread that called hnbrdf_fit(), by all ranks in the same order, with sizes
 * that fit together; the bytes are those of machines alike. There is no callback for sums: the
 * library adds in an order of its own, so that no bit depends on the number of ranks. Each returns
 * 0, or non-zero where a rank cannot be reached: the fit then ends with HNBRDF_ERROR_IO. */
typedef struct hnbrdf_communicator {
    int rank, size; /* 0 <= rank < size */
    /* What every rank has, to all: bytes[r] of them from rank r, one after the other in `all`. */
    int (*gather)(void *user, const void *mine, void *all, const size_t *bytes);
    /* send_bytes[r] for rank r, one after the other in `send`; so is what comes from them. */
    int (*exchange)(void *user, const void *send, const size_t *send_bytes, void *received,
                    const size_t *received_bytes);
    /* What rank `root` has, to all. */
    int (*broadcast)(void *user, void *data, size_t bytes, int root);
    void *user;
} hnbrdf_communicator;

/* By all ranks: the result and the message of the first that failed, on all of them; else OK. *flag
 * becomes the bitwise or of all; it may be NULL. ranks may be NULL: there is one. */
HNBRDF_EXPERIMENTAL hnbrdf_result hnbrdf_ranks_agree(const hnbrdf_communicator *ranks,
                                                     hnbrdf_result mine, int *flag,
                                                     hnbrdf_error *error);

/* A fitted material with the network and without it, over the training pairs and in a small picture
 * of a sphere under an even light and a sun of 3 degrees: of three suns the one under which the
 * network does worst. */
typedef struct hnbrdf_fit_worth {
    double smape, ggx_smape;     /* mean over up to 16384 of the pairs */
    double picture, ggx_picture; /* mean squared error of the radiance; the even light has 1 */
    /* the largest that nobody sees: half a step of 8 bits, the largest radiance being 255 */
    double unseen;
    /* 1: worse with the network, in SMAPE or in that picture; what the picture loses does not count
     * where it is unseen and SMAPE is at most half */
    int worse;
    int alone; /* 1: for that left to GGX alone; the figures are those before */
} hnbrdf_fit_worth;

/* Zero-initialise for defaults: 0 is the default of every field. Where 0 itself is wanted, a flag
 * named ..._none asks for it; a number beside such a flag is refused. */
typedef struct hnbrdf_fit_options {
    hnbrdf_kind kind;   /* default hybrid */
    int hidden, layers; /* HxN; 0 stands for 32 and 2 */
    int latent;         /* l; 0 stands for 4 (hybrid) or 12 (neural) */
    int latent_none;    /* 1: no latent code; enough for one material */
    /* a name as hnbrdf_encoding_name() gives it. NULL: angles-azimuths if any material is
     * anisotropic; else angles, or angles-directed where f(wi, wo) and f(wo, wi) of the data have
     * a mean SMAPE above 0.02 over uniform pairs */
    const char *encoding;
    float floor;    /* b, below 1; 0 stands for 0.003 */
    int floor_none; /* 1: b = 0 */
    hnbrdf_fit_analytic analytic;
    /* [count], each passes hnbrdf_material_check(), or NULL. Their kd, eta, alpha and rotation are
     * taken instead of a GGX fit: kept as they are (faithful) or where training starts (joint). */
    const hnbrdf_material *materials;
    hnbrdf_fit_search *search; /* [count] written: how the GGX fit of each material went, or NULL */
    /* [count] written: what was found in the data of each material, or NULL */
    hnbrdf_fit_drawn *drawn;
    /* [count] written of a hybrid: what its network does for each material, or NULL */
    hnbrdf_fit_worth *worth;
    long steps;     /* network steps; 0 stands for 32000 */
    double seconds; /* time budget for the network stage instead of steps */
    int batch;      /* pairs a step; 0 stands for 2048; rounded up to a multiple of 1024 */
    /* pairs drawn per material before training; 0: 131072, on a frozen network 16384, or what makes
     * 1.25e9 bytes of all */
    int pool;
    /* bytes of pairs, 72 each, that this process keeps; those of further materials are drawn again
     * whenever they are wanted: the same model, later. 0: no limit */
    size_t memory;
    /* The peak rate of the latent codes, by Adam (Kingma and Ba 2015); the network's weights take
     * twice that, by Adam in the eigenbases of their gradients (SOAP, Vyas et al. 2024). 0 stands
     * for 6e-2 min(1, 64/(HN)), HxN the network */
    float learning_rate;
    hnbrdf_fit_loss loss;
    hnbrdf_fit_schedule schedule;
    /* of the pairs, drawn within 6 degrees of the horizon, down to 0.57 degrees, as measurements
     * end earlier: f is that of the nearest measurement. And all pairs within 11 degrees of it
     * are multiplied by what keeps the albedo of the data below 1 there: readers go on beyond
     * the last sample without end. At most 1; 0 stands for 0.03 */
    float horizon_share;
    int horizon_none; /* 1: neither; data as they are read */
    /* of the other pairs, drawn where a picture of the material is bright, about in proportion to
     * f wi.z wo.z; at most 1; 0 stands for 0.25 */
    float bright_share;
    int bright_none; /* 1: no such pairs */
    /* of all other pairs, drawn by the uniform sampler, the rest by grid; at most 1; 0 stands for
     * 0.667 */
    float uniform_share;
    int uniform_none; /* 1: those by grid */
    /* Of a hybrid: where f is below the data by more than a factor of 1.25, the derivative of
     * exp(c) is taken as at least this share of the gated GGX. Without it a correction that is
     * small beside GGX stays small in highlights where GGX is too low. At most 1; 0 stands for 1 */
    float lift;
    int lift_none; /* 1: the derivative as it is */
    /* 1: materials without lobes (hnbrdf_lobes), which take 20 ms each; hnbrdf_lobes_fit() makes
     * them later */
    int lobes_none;
    uint64_t seed; /* of everything random */
    int threads;   /* 0: all cores */
    hnbrdf_fit_progress_fn progress;
    void *progress_user;
    /* Keep this model's network: only kd, eta, alpha and the latent codes of the new materials are
     * fitted (steps default to 48). The result holds them first, then the model's own
     * materials; one of the same name is replaced. Kind, sizes, encoding and floor are the
     * model's. */
    const hnbrdf_model *freeze;
    /* Where the state of training is kept, written twice a minute and when the callback stops the
     * fit; NULL for none. With resume = 1 training goes on from there, and ends with the very
     * model that an uninterrupted fit of the same steps gives. The caller removes the file when
     * it is done with it. */
    const char *checkpoint;
    int resume; /* 1: go on from `checkpoint` */
    /* Fit with other processes; NULL: alone. data[m] may be NULL where another rank has it: its
     * pairs, GGX fit and lobes are made there (where several have it, by one of them). `search` and
     * `drawn` are complete on all ranks; `checkpoint` is read and written by rank 0, and good for
     * any number of ranks. A callback that stops the fit stops it on all ranks. `threads`, `memory`
     * and the callback may differ between ranks, nothing else. A rank that fails alone before it
     * can tell the others, as without memory, must be ended together with them by the caller. */
    const hnbrdf_communicator *ranks;
} hnbrdf_fit_options;

/* Where the time of a fit went, in processor seconds summed over its threads; all but `waiting` is
 * work, whatever else the machine was busy with. */
typedef struct hnbrdf_fit_times {
    double drawing;  /* random directions and their measured values */
    double ggx;      /* the GGX fits */
    double encoding; /* what the network sees, and f_a where it is frozen */
    double network;  /* forward and backward passes */
    /* steps of the weights, on as many threads as there are layers; choice of pairs, sum of the
     * gradients, steps of the codes, checkpoints, on one */
    double update;
    double exchange; /* talking to other ranks and waiting for them: elapsed, of one thread */
    /* threads times elapsed time less all of these: idle, or taken by other programs */
    double waiting;
} hnbrdf_fit_times;

/* How a fit went. */
typedef struct hnbrdf_fit_report {
    double final_loss;  /* running mean of the training loss; best_loss where an earlier state was
                           returned */
    double seconds;     /* whole fit */
    double pairs_per_s; /* network stage */
    long steps;         /* network steps done, those before a resume included */
    int stopped;        /* 1: the progress callback asked to stop */
    double pairs; /* direction pairs that the network was trained on in this call, by all ranks */
    int ranks;    /* processes of the fit */
    double flops; /* floating-point operations of its passes in this call: the products alone, two a
                     multiply-add, none for padding */
    hnbrdf_fit_times times;
    int threads;              /* that it ran on */
    double kept;              /* bytes of pairs that this process kept */
    int redrawn;              /* its materials whose pairs were drawn again, for want of `memory` */
    const char *instructions; /* of the kernels: "plain", "avx2" or "avx512" */
    /* Of a network: how the training went, see "Divergence" above. Losses are means over a sample
     * of the training pairs, SMAPE unless HNBRDF_FIT_LOG is minimised. */
    /* times that training had diverged and was set back to the best state before */
    int set_backs;
    double rate; /* the peak rate at the end: learning_rate times 0.3 for each of them */
    /* the step whose state was returned: `steps`, or an earlier one that was better by more than
     * 5 % plus 0.001 */
    long best_step;
    int ggx_alone; /* 1: none was as good as GGX alone; the network returned leaves GGX as it is.
                         best_step is 0 */
    /* Materials that the network makes worse than GGX alone (hnbrdf_fit_worth): those whose
     * code turns it off, so that they are GGX, and those that have no such code, because the
     * network has a single hidden layer, fewer than 16 units in one, or was frozen and trained
     * without */
    int left_alone, worse;
    double best_loss; /* of the state returned */
    double ggx_loss;  /* of GGX alone; NaN but for a hybrid whose network was trained */
} hnbrdf_fit_report;

/* Fit one model to count materials. report may be NULL; its times are those of this process. */
HNBRDF_API hnbrdf_result hnbrdf_fit(const hnbrdf_measured *const *data, int count,
                                    const hnbrdf_fit_options *options, hnbrdf_model **model,
                                    hnbrdf_fit_report *report, hnbrdf_error *error);

/* What a step of training by several ranks takes, by the sizes of messages alone; of the rank with
 * the most to do. */
typedef struct hnbrdf_fit_traffic {
    /* ranks that have pairs to work on: a step has so many tiles of 64 pairs, and where there are
     * more than 16 tiles a rank, 16 chunks */
    int working;
    double pairs;          /* that it works on */
    double flops;          /* floating-point operations on its pairs, as in hnbrdf_fit_report */
    double shared, own;    /* numbers that every rank updates: of the network, of all materials */
    double pair_bytes;     /* of pairs that come from the ranks that hold them, on average */
    double gradient_bytes; /* of gradients that it sends to those that add them up */
    double sum_bytes;      /* of sums that it hears from all others */
} hnbrdf_fit_traffic;

/* Of hnbrdf_fit() with these options, count materials and so many ranks. options may be NULL. */
HNBRDF_EXPERIMENTAL hnbrdf_result hnbrdf_fit_traffic_of(const hnbrdf_fit_options *options,
                                                        int count, int ranks,
                                                        hnbrdf_fit_traffic *traffic,
                                                        hnbrdf_error *error);

#ifdef __cplusplus
}
#endif

#endif
