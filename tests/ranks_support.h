/* ranks_support.h: the ranks of one fit as threads of one process, so that tests of many ranks need
 * no MPI. */
#ifndef HNBRDF_TESTS_RANKS_SUPPORT_H
#define HNBRDF_TESTS_RANKS_SUPPORT_H

#include "hnbrdf/fit.h"

enum { TEST_RANKS_MOST = 24 };

typedef struct test_ranks test_ranks;

/* What one rank does; `ranks` is its communicator. */
typedef void (*test_rank_fn)(void *context, const hnbrdf_communicator *ranks);

/* Runs so many ranks at once and returns when all are done; 0 if it could not. A rank that returns
 * before the others is one that has died: their callbacks then fail. */
int test_ranks_run(int count, test_rank_fn work, void *context);

#endif
