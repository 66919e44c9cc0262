/* ranks_mpi.c: the communicator of a fit by MPI, of any kind that has version 3.
 *
 * A rank waits awake, as messages come every fraction of a millisecond, but gives its processor to
 * others that wait for one. A launcher that sees a rank die ends the others by SIGTERM and, a
 * second later, SIGKILL: whoever waits in vain after such a signal gives up in between, so that the
 * fit can still save what it has and say so. */
#include "cli/ranks.h"

#include "base/clock.h"
#include "base/interrupt.h"
#include "cli/cli.h"

#include <limits.h>
#include <mpi.h>
#include <sched.h>
#include <stdlib.h>

#define GIVE_UP 0.4    /* seconds after a signal */
enum { AWAKE = 2000 }; /* looks before others get the processor */

static int *counts[4]; /* [ranks] numbers and places of what is sent and received */
static int lost;       /* 1: a rank did not come */

/* Until the request is done; non-zero where it will not be. */
static int wait_for(MPI_Request *request, double patience)
{
    double signalled = 0.0;
    const double started = hnbrdf_seconds();
    for (long looks = 1;; looks++) {
        int done = 0;
        if (MPI_Test(request, &done, MPI_STATUS_IGNORE) != MPI_SUCCESS)
            return lost = 1;
        if (done)
            return 0;
        if (looks % AWAKE)
            continue;
        sched_yield();
        const double now = hnbrdf_seconds();
        if (hnbrdf_interrupted() && signalled == 0.0)
            signalled = now;
        if ((signalled > 0.0 && now - signalled > GIVE_UP) ||
            (patience >= 0.0 && now - started > patience))
            return lost = 1;
    }
}

/* Bytes of all ranks as MPI wants them; 0 if they are too many for it. */
static int place(const size_t *bytes, int size, int *numbers, int *places)
{
    size_t at = 0;
    for (int r = 0; r < size; r++) {
        numbers[r] = (int)bytes[r];
        places[r] = (int)at;
        at += bytes[r];
    }
    return at <= INT_MAX;
}

static int gather(void *user, const void *mine, void *all, const size_t *bytes)
{
    const hnbrdf_communicator *ranks = user;
    MPI_Request request;
    return lost || !place(bytes, ranks->size, counts[0], counts[1]) ||
           MPI_Iallgatherv(mine, counts[0][ranks->rank], MPI_BYTE, all, counts[0], counts[1],
                           MPI_BYTE, MPI_COMM_WORLD, &request) != MPI_SUCCESS ||
           wait_for(&request, -1.0);
}

static int exchange(void *user, const void *send, const size_t *send_bytes, void *received,
                    const size_t *received_bytes)
{
    const hnbrdf_communicator *ranks = user;
    MPI_Request request;
    return lost || !place(send_bytes, ranks->size, counts[0], counts[1]) ||
           !place(received_bytes, ranks->size, counts[2], counts[3]) ||
           MPI_Ialltoallv(send, counts[0], counts[1], MPI_BYTE, received, counts[2], counts[3],
                          MPI_BYTE, MPI_COMM_WORLD, &request) != MPI_SUCCESS ||
           wait_for(&request, -1.0);
}

static int broadcast(void *user, void *data, size_t bytes, int root)
{
    MPI_Request request;
    (void)user;
    return lost || bytes > INT_MAX ||
           MPI_Ibcast(data, (int)bytes, MPI_BYTE, root, MPI_COMM_WORLD, &request) != MPI_SUCCESS ||
           wait_for(&request, -1.0);
}

int cli_mpi_begin(int launched, hnbrdf_communicator *ranks)
{
    (void)launched; /* MPI knows */
    int given, rank, size;
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &given) != MPI_SUCCESS ||
        MPI_Comm_rank(MPI_COMM_WORLD, &rank) != MPI_SUCCESS ||
        MPI_Comm_size(MPI_COMM_WORLD, &size) != MPI_SUCCESS)
        return cli_fail("MPI does not start");
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    for (int k = 0; k < 4; k++)
        if (!(counts[k] = calloc((size_t)size, sizeof(int))))
            return cli_fail("out of memory");
    if (size > 1)
        *ranks = (hnbrdf_communicator){rank, size, gather, exchange, broadcast, ranks};
    else
        MPI_Finalize();
    return CLI_OK;
}

int cli_mpi_end(double patience)
{
    MPI_Request request;
    if (lost || MPI_Ibarrier(MPI_COMM_WORLD, &request) != MPI_SUCCESS ||
        wait_for(&request, patience))
        return 0;
    MPI_Finalize();
    for (int k = 0; k < 4; k++)
        free(counts[k]);
    return 1;
}

void cli_mpi_abort(int code)
{
    MPI_Abort(MPI_COMM_WORLD, code);
}
