/* ranks.c: this process as one of several. */
#include "cli/ranks.h"

#include "cli/cli.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#define PATIENCE 3.0 /* seconds that a rank which failed waits for the others to do so too */

static hnbrdf_communicator communicator = {.size = 1};
static int loud = -1; /* where this rank may print if it must */

const hnbrdf_communicator *cli_ranks(void)
{
    return communicator.size > 1 ? &communicator : NULL;
}

int cli_rank(void)
{
    return communicator.rank;
}

int cli_rank_count(void)
{
    return communicator.size;
}

/* Ranks, by what launchers tell in the environment: 0 where there is none, -1 where it does not
 * tell. */
static int count_launched(void)
{
    /* Open MPI; MPICH and its kin; MVAPICH */
    static const char *const sizes[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE"};
    static const char *const ranks[] = {"PMIX_RANK", "PMI_RANK"};
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        const char *size = getenv(sizes[k]);
        if (size && atoi(size) > 0)
            return atoi(size);
    }
    for (size_t k = 0; k < sizeof ranks / sizeof ranks[0]; k++)
        if (getenv(ranks[k]))
            return -1;
    return 0;
}

/* What this rank prints goes nowhere from here on. */
static void fall_silent(void)
{
    const int nowhere = open("/dev/null", O_WRONLY);
    fflush(NULL);
    loud = dup(STDERR_FILENO);
    if (nowhere < 0 || loud < 0)
        return;
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    close(nowhere);
}

int cli_ranks_begin(void)
{
    const int launched = count_launched();
    const int code =
        launched == 0 || launched == 1 ? CLI_OK : cli_mpi_begin(launched, &communicator);
    if (communicator.rank > 0)
        fall_silent();
    return code;
}

/* Of a rank that nobody hears otherwise. */
static void print_kept(void)
{
    const char *line = cli_last_message();
    if (communicator.rank > 0 && loud >= 0 && line[0])
        dprintf(loud, "hnbrdf: rank %d of %d: %s\n", communicator.rank, communicator.size, line);
}

int cli_ranks_agree(int code)
{
    if (communicator.size == 1)
        return code;
    hnbrdf_error error;
    snprintf(error.text, sizeof error.text, "%s", cli_last_message());
    const int before = code;
    const hnbrdf_result result = code ? HNBRDF_ERROR_ARGUMENT : HNBRDF_OK;
    if (hnbrdf_ranks_agree(&communicator, result, &code, &error) == HNBRDF_OK)
        return CLI_OK;
    if (!before)
        cli_fail("%s", error.text); /* of another rank */
    code = code ? code : CLI_FAILURE;
    return code;
}

int cli_ranks_end(int code)
{
    if (communicator.size == 1)
        return code;
    /* a rank that did its part waits for the first, which writes */
    if (cli_mpi_end(code ? PATIENCE : -1.0))
        return code;
    print_kept();
    cli_mpi_abort(code ? code : CLI_FAILURE);
    return code ? code : CLI_FAILURE;
}
