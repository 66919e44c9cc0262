/* fuzz_checkpoint.c: the bytes are the state of a fit to go on from, after the fingerprint, which
 * would else refuse them all. What is taken is a state that training can stand in. */
#include "fuzz.h"

#include "fit/trainer.h"

#include <sys/mman.h>
#include <unistd.h>

enum { NUMBERS = 5, MATERIALS = 2, TILES = 4, MAGIC = 16, FINGERPRINT = 8, ROOM = 4096 };

static fit_material known[MATERIALS] = {{.name = "a"}, {.name = "b"}};
static unsigned char start[MAGIC + FINGERPRINT]; /* of every checkpoint of this fit */
static char path[64];
static int file;

/* The smallest part of a trainer that checkpoints look at. */
static trainer make_trainer(float *parameters, float *best, int *order, int *cursor)
{
    trainer t;
    memset(&t, 0, sizeof t);
    t.known = known;
    t.ranks.size = 1;
    t.count = MATERIALS;
    t.options.checkpoint = path;
    t.layout.count = NUMBERS;
    t.pool.tiles = TILES;
    t.parameters = parameters;
    t.best = best;
    t.schedule.order = order;
    t.schedule.cursor = cursor;
    return t;
}

/* A checkpoint is written once, in a folder that is gone afterwards, for its first bytes. */
static void learn_start(void)
{
    float parameters[3 * NUMBERS] = {0}, best[NUMBERS] = {0};
    int order[MATERIALS] = {0, 1}, cursor[MATERIALS] = {0};
    char folder[] = "/tmp/hnbrdf_fuzz_XXXXXX";
    FUZZ_CHECK(mkdtemp(folder) != NULL);
    snprintf(path, sizeof path, "%s/c", folder);
    trainer t = make_trainer(parameters, best, order, cursor);
    FUZZ_CHECK(hnbrdf_fit_checkpoint_save(&t, NULL) == HNBRDF_OK);
    FILE *written = fopen(path, "rb");
    FUZZ_CHECK(written && fread(start, 1, sizeof start, written) == sizeof start);
    fclose(written);
    remove(path);
    rmdir(folder);
    file = memfd_create("fuzz", 0);
    FUZZ_CHECK(file >= 0);
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
}

static void check_state(const trainer *t)
{
    FUZZ_CHECK(t->step >= 0 && t->share >= 0.0 && t->share < 1.0 && t->peak > 0.0 &&
               isfinite(t->peak));
    FUZZ_CHECK(t->schedule.at >= 0 && t->schedule.at < MATERIALS);
    for (int i = 0; i < 3 * NUMBERS; i++)
        FUZZ_CHECK(isfinite(t->parameters[i]));
    FUZZ_CHECK(t->since >= 0 && t->since <= t->step && t->best_step >= 0 &&
               t->best_step <= t->step);
    FUZZ_CHECK(t->set_backs >= 0 && t->best_dead >= 0 && t->best_loss >= 0.0 &&
               isfinite(t->best_loss));
    for (int i = 0; i < NUMBERS; i++)
        FUZZ_CHECK(isfinite(t->best[i]));
    for (int m = 0; m < MATERIALS; m++)
        FUZZ_CHECK(t->schedule.order[m] >= 0 && t->schedule.order[m] < MATERIALS &&
                   t->schedule.cursor[m] >= 0 && t->schedule.cursor[m] < TILES);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    unsigned char bytes[sizeof start + ROOM];
    float *parameters = calloc(3 * NUMBERS, sizeof *parameters),
          *best = calloc(NUMBERS, sizeof *best);
    int *order = calloc(MATERIALS, sizeof *order), *cursor = calloc(MATERIALS, sizeof *cursor);
    hnbrdf_error error = {""};
    FUZZ_CHECK(parameters && best && order && cursor);
    if (!path[0])
        learn_start();
    size = size < ROOM ? size : ROOM;
    memcpy(bytes, start, sizeof start);
    if (size)
        memcpy(bytes + sizeof start, data, size);
    FUZZ_CHECK(ftruncate(file, 0) == 0);
    FUZZ_CHECK(pwrite(file, bytes, sizeof start + size, 0) == (ssize_t)(sizeof start + size));
    trainer t = make_trainer(parameters, best, order, cursor);
    const hnbrdf_result result = hnbrdf_fit_checkpoint_load(&t, &error);
    if (result)
        fuzz_check_refusal(result, &error);
    else
        check_state(&t);
    free(parameters);
    free(best);
    free(order);
    free(cursor);
    return 0;
}
