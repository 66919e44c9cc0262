/* lobes.h: the lobes with which a model's materials are sampled, of all materials at once. */
#ifndef HNBRDF_CLI_LOBES_H
#define HNBRDF_CLI_LOBES_H

#include "cli/cli.h"

typedef enum lobes_scheme {
    LOBES_FITTED = 0, /* hnbrdf_lobes_fit() */
    LOBES_PAPER,      /* hnbrdf_lobes_paper() */
    LOBES_GUESS       /* none: what hnbrdf_sample() guesses from kd and eta */
} lobes_scheme;

/* Puts a model with lobes of this scheme in the place of *model, which is freed; on failure it
 * stays. Tells progress. Returns 0, or CLI_FAILURE after a message. */
int lobes_set_all(hnbrdf_model **model, lobes_scheme scheme);

#endif
