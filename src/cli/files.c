/* files.c: the files that the options of a command name, looked at before any work: may they be
 * written, and would one take the place of something that is still needed? */
#include "cli/cli.h"
#include "base/text.h"
#include "image/image.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MOST_WRITTEN = 16, HEAD_SIZE = 512 };

/* What this process writes, in the order of the options. */
typedef struct written_file {
    const cli_option *option;
    const char *path;
} written_file;
static written_file written[MOST_WRITTEN];
static int written_count;
static char *png_beside; /* of the one picture with a PNG beside it */

/* ---- Two names, one file --------------------------------------------------------------------- */

/* The folder of the path, and its last part. */
static int find_folder(const char *path, struct stat *folder, const char **last)
{
    char text[HNBRDF_PATH_SIZE];
    const char *slash = strrchr(path, '/');
    const size_t length = slash ? (size_t)(slash - path) + 1 : 0;
    *last = path + length;
    if (length >= sizeof text)
        return 0;
    memcpy(text, path, length);
    text[length] = '\0';
    return stat(length ? text : ".", folder) == 0;
}

static int same_file(const char *a, const char *b)
{
    struct stat of_a, of_b;
    const char *last_a, *last_b;
    const int a_there = stat(a, &of_a) == 0, b_there = stat(b, &of_b) == 0;
    if (a_there != b_there)
        return 0;
    if (!a_there && (!find_folder(a, &of_a, &last_a) || !find_folder(b, &of_b, &last_b) ||
                     strcmp(last_a, last_b) != 0))
        return 0;
    return of_a.st_dev == of_b.st_dev && of_a.st_ino == of_b.st_ino &&
           (S_ISREG(of_a.st_mode) || S_ISDIR(of_a.st_mode));
}

/* ---- What is there --------------------------------------------------------------------------- */

/* The first bytes of a regular file; 0 for anything else: a pipe would lose what was read. */
static size_t read_head(const char *path, char head[HEAD_SIZE])
{
    struct stat status;
    FILE *file =
        stat(path, &status) == 0 && S_ISREG(status.st_mode) ? hnbrdf_open_to_read(path) : NULL;
    const size_t size = file ? fread(head, 1, HEAD_SIZE, file) : 0;
    if (file)
        fclose(file);
    return size;
}

/* safetensors: a u64 header length, below 2^32, then a JSON object. No measured format has '{'
 * there: MERL has the number 180 and RGL the letters "tensor_file"; UTIA may, but its first eight
 * bytes are a double, with zeros high up only if it is 0, and no header is empty. */
static int is_model(const char *head, size_t size)
{
    static const char zeros[8];
    return size > 8 && head[8] == '{' && memcmp(head + 4, zeros, 4) == 0 &&
           memcmp(head, zeros, 8) != 0;
}

int cli_looks_like_model(const char *path)
{
    char head[HEAD_SIZE];
    return is_model(head, read_head(path, head));
}

/* A name that stands for the wrong thing, as `--csv *.bsdf` does: text takes the place of no
 * measurement, model or picture, a model that of nothing but a model. */
static int check_replaced(const written_file *w)
{
    char head[HEAD_SIZE];
    const size_t size = read_head(w->path, head);
    const char *found = NULL;
    if (w->option->type == CLI_WRITE_TEXT && memchr(head, '\0', size))
        found = "no text";
    if (w->option->type == CLI_WRITE_MODEL && size && !is_model(head, size))
        found = "no model";
    return found ? cli_fail("%s: is there and is %s, so --%s does not overwrite it; remove it or "
                            "give another name",
                            w->path, found, w->option->name)
                 : CLI_OK;
}

static int check_folder(const char *path)
{
    char inside[HNBRDF_PATH_SIZE];
    struct stat status;
    if (stat(path, &status) != 0)
        return cli_output_check(path); /* asks the folder above */
    if (!S_ISDIR(status.st_mode))
        return cli_fail("%s: is a file, expected a folder or a new name for one", path);
    if (snprintf(inside, sizeof inside, "%s/hnbrdf", path) >= (int)sizeof inside)
        return cli_fail("%s: File name too long", path);
    return cli_output_check(inside);
}

/* ---- One file ---------------------------------------------------------------------------------*/

static int check_written(const cli_command *command, const written_file *w)
{
    const cli_type type = w->option->type;
    for (const written_file *other = written; other != w; other++)
        if (cli_is_stdout(w->path) && cli_is_stdout(other->path))
            return cli_usage(command, "only one of --%s and --%s can be standard output",
                             other->option->name, w->option->name);
        else if (same_file(w->path, other->path) || strcmp(w->path, other->path) == 0)
            return cli_usage(command, "--%s and --%s both write %s", other->option->name,
                             w->option->name, w->path);
    if (cli_is_stdout(w->path))
        return type == CLI_WRITE_TEXT || type == CLI_WRITE_BYTES
                   ? -1
                   : cli_usage(command,
                               "--%s: found -, which stands for standard output, expected a name; "
                               "./- is a file called so",
                               w->option->name);
    if ((type == CLI_WRITE_FOLDER ? check_folder(w->path) : cli_output_check(w->path)) != CLI_OK)
        return CLI_FAILURE;
    return check_replaced(w) == CLI_OK ? -1 : CLI_FAILURE;
}

static int add_written(const cli_command *command, const cli_option *option, const char *path)
{
    if (written_count == MOST_WRITTEN)
        return cli_usage(command, "more than %d files to write", (int)MOST_WRITTEN);
    written[written_count++] = (written_file){option, path};
    if (cli_is_stdout(path))
        cli_give_stdout_to_data();
    return check_written(command, &written[written_count - 1]);
}

static int writes(const cli_option *option)
{
    return option->type >= CLI_WRITE_TEXT && option->type <= CLI_WRITE_FOLDER;
}

static const char *path_of(const cli_option *option)
{
    return *(const char *const *)option->value;
}

static int add_option(const cli_command *command, const cli_option *option)
{
    const char **path = (const char **)option->value;
    if (!writes(option) || !*path)
        return -1;
    /* What a shell has redirected is gone on with, not replaced. */
    if (option->type == CLI_WRITE_TEXT &&
        (strcmp(*path, "/dev/stdout") == 0 || strcmp(*path, "/dev/fd/1") == 0))
        *path = "-";
    int code = add_written(command, option, *path);
    if (code >= 0 || option->type != CLI_WRITE_PICTURE || !hnbrdf_ends_with(*path, ".exr"))
        return code;
    free(png_beside);
    png_beside = report_png_beside(*path);
    return png_beside ? add_written(command, option, png_beside) : cli_fail("out of memory");
}

/* ---- All of them ----------------------------------------------------------------------------- */

int cli_check_read(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0 || S_ISDIR(status.st_mode))
        return CLI_OK;
    for (const written_file *w = written; w != written + written_count; w++) {
        const int in_place = w->option->type == CLI_WRITE_MODEL && cli_looks_like_model(path);
        if (!in_place && !cli_is_stdout(w->path) && same_file(w->path, path))
            return cli_fail("%s: is read, and --%s would overwrite it; give another name", path,
                            w->option->name);
    }
    return CLI_OK;
}

int cli_check_files(const cli_command *command, const cli_option *options, char *const *arguments,
                    int count)
{
    const cli_option *option;
    int code = -1;
    written_count = 0;
    for (int k = 0; code < 0 && (option = cli_option_at(options, k)); k++)
        code = add_option(command, option);
    for (int k = 0; code < 0 && (option = cli_option_at(options, k)); k++)
        if (option->type == CLI_READ && path_of(option) && cli_check_read(path_of(option)))
            code = CLI_FAILURE;
    for (int k = 0; code < 0 && k < count; k++)
        if (cli_check_read(arguments[k]) != CLI_OK)
            code = CLI_FAILURE;
    return code;
}
