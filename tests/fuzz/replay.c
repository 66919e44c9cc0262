/* replay.c: runs a fuzz target with any compiler. Arguments:
 *   PATH             a file, or a directory whose files are taken in byte order of their names
 *   --generate N     files 0 to N - 1 of the target's generator
 *   --print SEED     writes that file to standard output
 * What the fuzzer once found must never come back. */
#include "fuzz.h"
#include "generate.h"

#include <dirent.h>
#include <sys/stat.h>

static long replayed;

/* A target may lack one. */
extern fuzz_generator *const fuzz_target_generator __attribute__((weak));

static void replay_bytes(const void *data, size_t size)
{
    uint8_t *copy = fuzz_copy(data, size);
    LLVMFuzzerTestOneInput(copy, size);
    FUZZ_CHECK(size == 0 || memcmp(copy, data, size) == 0);
    free(copy);
    replayed++;
}

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
    replay_bytes(data, size);
    free(data);
}

/* A generated file that ends badly ends as the core or the sanitizer says; its number is printed
 * first. */
static void replay_generated(const char *count)
{
    const long most = strtol(count, NULL, 10);
    FUZZ_CHECK(most > 0 && &fuzz_target_generator != NULL);
    for (long seed = 0; seed < most; seed++) {
        fuzz_bytes made = {0};
        fuzz_generate(fuzz_target_generator, (uint64_t)seed, &made);
        printf("--generate: %ld\n", seed);
        fflush(stdout);
        replay_bytes(made.data, made.size);
        fuzz_free(&made);
    }
}

static void print_generated(const char *seed)
{
    fuzz_bytes made = {0};
    fuzz_generate(fuzz_target_generator, strtoull(seed, NULL, 10), &made);
    FUZZ_CHECK(made.size == 0 || fwrite(made.data, 1, made.size, stdout) == made.size);
    fuzz_free(&made);
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
    for (int i = 1; i < argc; i++) {
        if (i + 1 < argc && strcmp(argv[i], "--print") == 0) {
            print_generated(argv[i + 1]);
            return 0;
        }
        if (i + 1 < argc && strcmp(argv[i], "--generate") == 0)
            replay_generated(argv[++i]);
        else
            replay(argv[i]);
    }
    printf("%ld inputs\n", replayed);
    return replayed > 0 ? 0 : 1;
}
