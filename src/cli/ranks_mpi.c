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
#include <math.h>
#include <mpi.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>

#define GIVE_UP 0.4 /* seconds after a signal */
enum {
    AWAKE = 2000, /* looks before others get the processor */
    FEW = 16      /* ranks that tell each other one by one */
};

static int *counts[4]; /* [ranks] numbers and places of what is sent, and of what is received */
static MPI_Request *requests; /* [2 ranks] */
static int lost;              /* 1: a rank did not come */

/* Is it in vain to wait on? A look may take long where others have the processor: the clock is
 * asked at each of them once there is a reason. */
static int in_vain(double started, double patience)
{
    static double signalled;
    if (!hnbrdf_interrupted() && patience < 0.0)
        return 0;
    const double now = hnbrdf_seconds();
    if (hnbrdf_interrupted() && signalled == 0.0)
        signalled = now;
    return (signalled > 0.0 && now - fmax(signalled, started) > GIVE_UP) ||
           (patience >= 0.0 && now - started > patience);
}

/* Until all requests are done; non-zero where they will not be. */
static int wait_for(MPI_Request *pending, int count, double patience)
{
    const double started = hnbrdf_seconds();
    for (long looks = 1;; looks++) {
        int done = 0;
        if (MPI_Testall(count, pending, &done, MPI_STATUSES_IGNORE) != MPI_SUCCESS)
            return lost = 1;
        if (done)
            return 0;
        if (in_vain(started, patience))
            return lost = 1;
        if (looks % AWAKE == 0)
            sched_yield();
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

/* One message to each rank that gets something and from each that sends something, as the counts
 * say: sooner under way than a call for all of MPI. */
static int pass(const hnbrdf_communicator *ranks, const char *send, char *received)
{
    const int me = ranks->rank;
    int count = 0;
    memcpy(received + counts[3][me], send + counts[1][me], (size_t)counts[0][me]);
    for (int r = 0; r < ranks->size; r++)
        if (r != me && counts[2][r] > 0 &&
            MPI_Irecv(received + counts[3][r], counts[2][r], MPI_BYTE, r, 0, MPI_COMM_WORLD,
                      &requests[count++]) != MPI_SUCCESS)
            return lost = 1;
    for (int k = 1; k < ranks->size; k++) {
        const int r = (me + k) % ranks->size; /* not all to the same one at first */
        if (counts[0][r] > 0 && MPI_Isend(send + counts[1][r], counts[0][r], MPI_BYTE, r, 0,
                                          MPI_COMM_WORLD, &requests[count++]) != MPI_SUCCESS)
            return lost = 1;
    }
    return wait_for(requests, count, -1.0);
}

static int gather(void *user, const void *mine, void *all, const size_t *bytes)
{
    const hnbrdf_communicator *ranks = user;
    const int size = ranks->size;
    if (lost || !place(bytes, size, counts[2], counts[3]))
        return 1;
    if (size <= FEW) {
        for (int r = 0; r < size; r++) {
            counts[0][r] = counts[2][ranks->rank];
            counts[1][r] = 0;
        }
        return pass(ranks, mine, all);
    }
    return MPI_Iallgatherv(mine, counts[2][ranks->rank], MPI_BYTE, all, counts[2], counts[3],
                           MPI_BYTE, MPI_COMM_WORLD, requests) != MPI_SUCCESS ||
           wait_for(requests, 1, -1.0);
}

static int exchange(void *user, const void *send, const size_t *send_bytes, void *received,
                    const size_t *received_bytes)
{
    const hnbrdf_communicator *ranks = user;
    return lost || !place(send_bytes, ranks->size, counts[0], counts[1]) ||
           !place(received_bytes, ranks->size, counts[2], counts[3]) || pass(ranks, send, received);
}

static int broadcast(void *user, void *data, size_t bytes, int root)
{
    (void)user;
    return lost || bytes > INT_MAX ||
           MPI_Ibcast(data, (int)bytes, MPI_BYTE, root, MPI_COMM_WORLD, requests) != MPI_SUCCESS ||
           wait_for(requests, 1, -1.0);
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
    requests = calloc(2 * (size_t)size, sizeof *requests);
    if (!requests)
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
        wait_for(&request, 1, patience))
        return 0;
    MPI_Finalize();
    for (int k = 0; k < 4; k++)
        free(counts[k]);
    free(requests);
    return 1;
}

void cli_mpi_abort(int code)
{
    MPI_Abort(MPI_COMM_WORLD, code);
}
