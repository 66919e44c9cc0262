/* compile.c: GLSL to SPIR-V by glslangValidator, in a private directory that is gone afterwards. */
#include "gpu/compile.h"

#include "base/error.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

static const char COMPILER[] = "glslangValidator";
enum { PATH_SIZE = 512, EXIT_NOT_FOUND = 127, FIXED_ARGUMENTS = 8 };

int gpu_compiler_found(void)
{
    const char *path = getenv("PATH");
    while (path && *path) {
        char file[PATH_SIZE];
        size_t length = strcspn(path, ":");
        int printed = snprintf(file, sizeof file, "%.*s/%s", (int)length, path, COMPILER);
        if (printed > 0 && (size_t)printed < sizeof file && access(file, X_OK) == 0)
            return 1;
        path += length + (path[length] == ':');
    }
    return 0;
}

int gpu_text_append(void *user, const void *data, size_t size)
{
    gpu_text *text = user;
    if (text->size + size + 1 > text->room) {
        size_t room = 2 * (text->size + size + 1);
        char *grown = realloc(text->bytes, room);
        if (!grown)
            return 1;
        text->bytes = grown;
        text->room = room;
    }
    memcpy(text->bytes + text->size, data, size);
    text->size += size;
    text->bytes[text->size] = '\0';
    return 0;
}

/* ---- Files in the private directory ---------------------------------------------------------- */

typedef struct workplace {
    char directory[PATH_SIZE - 64];
} workplace;

static void path_in(const workplace *place, const char *name, char path[PATH_SIZE])
{
    snprintf(path, PATH_SIZE, "%s/%.60s", place->directory, name);
}

static hnbrdf_result open_workplace(workplace *place, hnbrdf_error *error)
{
    const char *base = getenv("TMPDIR");
    int printed = snprintf(place->directory, sizeof place->directory, "%s/hnbrdf-XXXXXX",
                           base && *base ? base : "/tmp");
    if (printed < 0 || (size_t)printed >= sizeof place->directory || !mkdtemp(place->directory))
        return hnbrdf_fail(error, HNBRDF_ERROR_IO, "%s: cannot make a temporary directory: %s",
                           place->directory, strerror(errno));
    return HNBRDF_OK;
}

static void remove_in(const workplace *place, const char *name)
{
    char path[PATH_SIZE];
    path_in(place, name, path);
    unlink(path);
}

static hnbrdf_result write_in(const workplace *place, const char *name, const char *text,
                              hnbrdf_error *error)
{
    char path[PATH_SIZE];
    path_in(place, name, path);
    FILE *file = fopen(path, "wb");
    size_t length = strlen(text);
    int written = file && fwrite(text, 1, length, file) == length;
    if (file && fclose(file) != 0)
        written = 0;
    return written
               ? HNBRDF_OK
               : hnbrdf_fail(error, HNBRDF_ERROR_IO, "%s: cannot write: %s", path, strerror(errno));
}

/* The whole file, NUL-terminated; NULL if it cannot be read. */
static char *read_in(const workplace *place, const char *name, size_t *size)
{
    char path[PATH_SIZE];
    path_in(place, name, path);
    FILE *file = fopen(path, "rb");
    char *bytes = NULL;
    long length = -1;
    if (file && fseek(file, 0, SEEK_END) == 0 && (length = ftell(file)) >= 0 &&
        fseek(file, 0, SEEK_SET) == 0)
        bytes = malloc((size_t)length + 1);
    if (bytes && fread(bytes, 1, (size_t)length, file) != (size_t)length) {
        free(bytes);
        bytes = NULL;
    }
    if (bytes) {
        bytes[length] = '\0';
        *size = (size_t)length;
    }
    if (file)
        fclose(file);
    return bytes;
}

/* ---- The compiler ---------------------------------------------------------------------------- */

static const char SOURCE[] = "shader.glsl", OUTPUT[] = "shader.spv", MESSAGES[] = "messages";

/* Exit status of the compiler, EXIT_NOT_FOUND if it cannot be run. */
static int run_compiler(const workplace *place, const char *stage, const char *const *defines)
{
    char source[PATH_SIZE], output[PATH_SIZE], messages[PATH_SIZE];
    char include[PATH_SIZE + 2], definitions[GPU_MAX_DEFINES][128];
    path_in(place, SOURCE, source);
    path_in(place, OUTPUT, output);
    path_in(place, MESSAGES, messages);
    snprintf(include, sizeof include, "-I%s", place->directory);
    char compiler[] = "glslangValidator", target[] = "-V", to[] = "-o", at[] = "-S", named[8];
    snprintf(named, sizeof named, "%s", stage);
    char *arguments[FIXED_ARGUMENTS + GPU_MAX_DEFINES + 1] = {compiler, target, at, named,
                                                              include,  source, to, output};
    for (int i = 0; defines && i < GPU_MAX_DEFINES && defines[i]; i++) {
        snprintf(definitions[i], sizeof definitions[i], "-D%s", defines[i]);
        arguments[FIXED_ARGUMENTS + i] = definitions[i];
    }
    posix_spawn_file_actions_t actions;
    if (posix_spawn_file_actions_init(&actions) != 0)
        return EXIT_NOT_FOUND;
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, messages,
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    pid_t child;
    int status = 0, failed = posix_spawnp(&child, COMPILER, &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed)
        return EXIT_NOT_FOUND;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            return EXIT_NOT_FOUND;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

static hnbrdf_result explain(const workplace *place, int status, hnbrdf_error *error)
{
    if (status == EXIT_NOT_FOUND)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s is not installed (Debian: apt-get install glslang-tools)", COMPILER);
    size_t size;
    char *messages = read_in(place, MESSAGES, &size);
    const char *first = messages ? strstr(messages, "ERROR") : NULL;
    if (messages)
        fputs(messages, stderr);
    hnbrdf_result result = hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: %.*s", COMPILER,
                                       first ? (int)strcspn(first, "\n") : 60,
                                       first ? first : "stopped without a message");
    free(messages);
    return result;
}

hnbrdf_result gpu_compile(const char *text, const gpu_include *includes, int include_count,
                          const char *const *defines, uint32_t **spirv, size_t *size,
                          hnbrdf_error *error)
{
    return gpu_compile_at("comp", text, includes, include_count, defines, spirv, size, error);
}

hnbrdf_result gpu_compile_at(const char *stage, const char *text, const gpu_include *includes,
                             int include_count, const char *const *defines, uint32_t **spirv,
                             size_t *size, hnbrdf_error *error)
{
    workplace place;
    hnbrdf_result result = open_workplace(&place, error);
    if (result)
        return result;
    result = write_in(&place, SOURCE, text, error);
    for (int i = 0; i < include_count && !result; i++)
        result = write_in(&place, includes[i].name, includes[i].text, error);
    if (!result) {
        int status = run_compiler(&place, stage, defines);
        char *bytes = status == 0 ? read_in(&place, OUTPUT, size) : NULL;
        if (bytes)
            *spirv = (uint32_t *)(void *)bytes;
        else
            result = explain(&place, status, error);
    }
    for (int i = 0; i < include_count; i++)
        remove_in(&place, includes[i].name);
    remove_in(&place, SOURCE);
    remove_in(&place, OUTPUT);
    remove_in(&place, MESSAGES);
    rmdir(place.directory);
    return result;
}
