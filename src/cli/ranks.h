/* ranks.h: this process as one of several that mpirun started, called ranks.
 *
 * The command is one program with or without MPI. It calls MPI only where a launcher has put its
 * variables into the environment, so that alone it neither starts nor needs a running MPI. A second
 * program would leave `mpirun hnbrdf fit`, several whole fits into one file, to be typed by
 * mistake. Ranks but the first say nothing: what they print goes nowhere. */
#ifndef HNBRDF_CLI_RANKS_H
#define HNBRDF_CLI_RANKS_H

#include "hnbrdf/fit.h"

/* At the start of the process, and at its end, which returns the exit code. A code from the start
 * ends the process. */
int cli_ranks_begin(void);
int cli_ranks_end(int code);

/* NULL where this process is alone. */
const hnbrdf_communicator *cli_ranks(void);
int cli_rank(void); /* 0 where it is alone */
int cli_rank_count(void);

/* By all ranks: the exit code of the first that has one, whose message is printed; else 0. */
int cli_ranks_agree(int code);

/* ---- ranks_mpi.c, or ranks_none.c where there is no MPI -------------------------------------- */

/* Of so many processes as a launcher tells, or -1 where it does not tell: fills *ranks, unless
 * there is one. Returns an exit code. */
int cli_mpi_begin(int launched, hnbrdf_communicator *ranks);
/* Meets all others, for so many seconds at most, and ends; 0 if they did not come: then everything
 * has to end. */
int cli_mpi_end(double patience);
/* Ends all ranks, this one too. */
void cli_mpi_abort(int code);

#endif
