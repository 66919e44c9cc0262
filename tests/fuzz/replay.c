/* replay.c: runs a fuzz target over files and directories given as arguments, in byte order of
 * their names, with any compiler: what the fuzzer once found must never come back. */
#include "fuzz.h"

#include <dirent.h>
#include <sys/stat.h>

static long replayed;

static void replay_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    struct stat status;
    FUZZ_CHECK(file != NULL && fstat(fileno(file), &status) == 0);
    size_t size = (size_t)status.st_size;
    unsigned char *data = malloc(size ? size : 1);
    FUZZ_CHECK(data != NULL && fread(data, 1, size, file) == size);
    fclose(file);
    printf("%s\n", path); /* the last line of a run that ends badly names its cause */
    fflush(stdout);
    uint8_t *copy = fuzz_copy(data, size);
    LLVMFuzzerTestOneInput(copy, size);
    FUZZ_CHECK(size == 0 || memcmp(copy, data, size) == 0);
    free(copy);
    free(data);
    replayed++;
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

static void replay(const char *path)
{
    struct stat status;
    struct dirent **entries;
    if (stat(path, &status) != 0)
        return; /* a target without crashers has no directory for them */
    if (!S_ISDIR(status.st_mode)) {
        replay_file(path);
        return;
    }
    int count = scandir(path, &entries, is_visible, by_name);
    FUZZ_CHECK(count >= 0);
    for (int i = 0; i < count; i++) {
        char name[4096];
        FUZZ_CHECK((size_t)snprintf(name, sizeof name, "%s/%s", path, entries[i]->d_name) <
                   sizeof name);
        replay_file(name);
        free(entries[i]);
    }
    free(entries);
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        replay(argv[i]);
    printf("%ld inputs\n", replayed);
    return replayed > 0 ? 0 : 1;
}
