/* ranks_none.c: without MPI there is one rank. */
#include "cli/ranks.h"

#include "cli/cli.h"

int cli_mpi_begin(int launched, hnbrdf_communicator *ranks)
{
    (void)ranks;
    return launched < 0 ? CLI_OK
                        : cli_fail("started as one of %d processes, but built without MPI: "
                                   "configure with HNBRDF_WITH_MPI=ON",
                                   launched);
}

int cli_mpi_end(double patience)
{
    (void)patience;
    return 1;
}

void cli_mpi_abort(int code)
{
    (void)code;
}
