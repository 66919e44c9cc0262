/* ranks.c: what the ranks of a bake tell each other: what a clock decided, and what was fitted. */
#include "bake/task.h"

#include <stdlib.h>
#include <string.h>

int hnbrdf_bake_rank(const bake_task *b)
{
    return b->options.ranks ? b->options.ranks->rank : 0;
}

int hnbrdf_bake_rank_count(const bake_task *b)
{
    return b->options.ranks ? b->options.ranks->size : 1;
}

hnbrdf_result hnbrdf_bake_spread(const bake_task *b, int from, void *data, size_t bytes,
                                 hnbrdf_error *error)
{
    const hnbrdf_communicator *ranks = b->options.ranks;
    if (!ranks || ranks->size == 1 || !ranks->broadcast(ranks->user, data, bytes, from))
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_IO, "another of %d ranks has ended or cannot be reached",
                       ranks->size);
}

/* The file of a model, in memory. */
typedef struct bytes {
    char *data;
    uint64_t size;
} bytes;

static int append(void *user, const void *data, size_t size)
{
    bytes *b = user;
    char *longer = realloc(b->data, (size_t)b->size + size + 1);
    if (!longer)
        return 1;
    memcpy(longer + b->size, data, size);
    b->data = longer;
    b->size += size;
    return 0;
}

hnbrdf_result hnbrdf_bake_spread_model(const bake_task *b, int from, hnbrdf_model **model,
                                       hnbrdf_error *error)
{
    const int mine = hnbrdf_bake_rank(b) == from;
    bytes file = {NULL, 0};
    hnbrdf_result result = mine ? hnbrdf_model_write(*model, append, &file, error) : HNBRDF_OK;
    result = hnbrdf_ranks_agree(b->options.ranks, result, NULL, error);
    if (!result)
        result = hnbrdf_bake_spread(b, from, &file.size, sizeof file.size, error);
    if (!result && !mine && !(file.data = malloc((size_t)file.size + 1)))
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for a model");
    result = hnbrdf_ranks_agree(b->options.ranks, result, NULL, error);
    if (!result)
        result = hnbrdf_bake_spread(b, from, file.data, (size_t)file.size, error);
    if (!result && !mine)
        result = hnbrdf_model_load_memory(file.data, (size_t)file.size, NULL, model, error);
    free(file.data);
    return hnbrdf_ranks_agree(b->options.ranks, result, NULL, error);
}
