/* fuzz_csv.c: after a byte that says of what, the bytes are what `hnbrdf eval` reads: pairs of
 * directions as CSV. The whole command runs, on files in memory. */
#include "fuzz.h"

#include "cli/cli.h"

#include <sys/mman.h>
#include <unistd.h>

/* An empty file in memory, and the path under which it can be opened. */
static int make_file(char path[64])
{
    int descriptor = memfd_create("fuzz", 0);
    FUZZ_CHECK(descriptor >= 0);
    snprintf(path, 64, "/proc/self/fd/%d", descriptor);
    return descriptor;
}

static int write_to(void *user, const void *data, size_t size)
{
    return write(*(int *)user, data, size) != (ssize_t)size;
}

/* A ggx model with two materials, so that a column must name one. */
static void write_model(int descriptor)
{
    static const char *const names[2] = {"a", "b, \"c\""};
    hnbrdf_material materials[2];
    const hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = 2, .materials = materials, .names = names};
    hnbrdf_model *model = NULL;
    hnbrdf_material_init(&materials[0]);
    hnbrdf_material_init(&materials[1]);
    FUZZ_CHECK(hnbrdf_model_create(&desc, NULL, &model, NULL) == HNBRDF_OK);
    FUZZ_CHECK(hnbrdf_model_write(model, write_to, &descriptor, NULL) == HNBRDF_OK);
    hnbrdf_model_free(model);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char model_path[64], in_path[64];
    static int in = -1;
    if (in < 0) {
        write_model(make_file(model_path));
        in = make_file(in_path);
    }
    if (size == 0)
        return 0;
    FUZZ_CHECK(ftruncate(in, 0) == 0);
    FUZZ_CHECK(pwrite(in, data + 1, size - 1, 0) == (ssize_t)(size - 1));
    char eval[] = "eval", builtin[] = "builtin:rough-clay", input[] = "-i", output[] = "-o";
    char nowhere[] = "/dev/null", material[] = "-m", name[] = "a";
    char *arguments[] = {
        eval, data[0] & 1 ? model_path : builtin, input, in_path, output, nowhere, NULL, NULL,
        NULL};
    const int named = data[0] & 1 && data[0] & 2;
    arguments[6] = named ? material : NULL;
    arguments[7] = named ? name : NULL;
    const int code = cmd_eval(named ? 8 : 6, arguments);
    FUZZ_CHECK(code == CLI_OK || code == CLI_FAILURE);
    return 0;
}
