/* sources.c: what DATA and SOURCE arguments name: built-in materials, measured files, models. */
#include "cli/cli.h"
#include "cli/ranks.h"
#include "cli/words.h"

#include "base/guess.h"
#include "base/text.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { NAMES_SHOWN = 16, NAMES_SIZE = 512 };

/* ---- Names ----------------------------------------------------------------------------------- */

/* "a, b, c and 7 more": the names of a collection for a message. */
typedef struct name_list {
    char text[NAMES_SIZE];
    size_t length;
    int shown, left_out;
} name_list;

static void list_name(name_list *list, const char *name)
{
    size_t length = strlen(name);
    if (list->shown == NAMES_SHOWN || list->length + length + 32 > NAMES_SIZE) {
        list->left_out++;
        return;
    }
    list->length += (size_t)snprintf(list->text + list->length, NAMES_SIZE - list->length, "%s%s",
                                     list->shown ? ", " : "", name);
    list->shown++;
}

static const char *finish_list(name_list *list)
{
    if (list->left_out > 0)
        snprintf(list->text + list->length, NAMES_SIZE - list->length, " and %d more",
                 list->left_out);
    return list->text;
}

/* " (did you mean X?)", or nothing. */
static const char *suggestion(const hnbrdf_guess *guess, char *text, size_t size)
{
    const char *nearest = hnbrdf_guess_nearest(guess);
    text[0] = '\0';
    if (nearest)
        snprintf(text, size, " (did you mean %s?)", nearest);
    return text;
}

static int fail_not_found(const char *where, const char *name, name_list *list,
                          const hnbrdf_guess *guess)
{
    char meant[HNBRDF_MAX_NAME + 32];
    return cli_fail("no material '%.*s' in %s%s; it has %s", HNBRDF_MAX_NAME, name, where,
                    suggestion(guess, meant, sizeof meant), finish_list(list));
}

/* ---- Built-in materials ---------------------------------------------------------------------- */

static const char *builtin_name_in(const char *path)
{
    return strncmp(path, "builtin:", 8) == 0 ? path + 8 : NULL;
}

/* Those a word stands for: 1 and a range of numbers, or 0. */
static int is_builtin_set(const char *argument, int *first, int *count)
{
    const int general = hnbrdf_measured_builtin_count();
    const int second = strcmp(argument, "builtin:anisotropic") == 0;
    *first = second ? general : 0;
    *count = second ? hnbrdf_measured_builtin_anisotropic_count() : general;
    return second || strcmp(argument, "builtin") == 0;
}

/* The number of "procedural-17"; -1: another name. */
static int procedural_number(const char *name)
{
    char *end;
    if (strncmp(name, "procedural-", 11) != 0 || name[11] < '0' || name[11] > '9')
        return -1;
    const long number = strtol(name + 11, &end, 10);
    return *end || number > HNBRDF_MAX_PROCEDURAL ? -1 : (int)number;
}

static int open_procedural(int number, hnbrdf_measured **measured)
{
    hnbrdf_error error;
    if (hnbrdf_measured_open_procedural(number, measured, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    return CLI_OK;
}

/* Its number, or -1 after a message. */
static int find_builtin(const char *name)
{
    name_list list = {0};
    const char *candidate;
    hnbrdf_guess guess;
    hnbrdf_guess_begin(&guess, name);
    hnbrdf_guess_offer(&guess, "anisotropic");
    for (int k = 0; (candidate = hnbrdf_measured_builtin_name(k)); k++) {
        if (strcmp(candidate, name) == 0)
            return k;
        list_name(&list, candidate);
        hnbrdf_guess_offer(&guess, candidate);
    }
    fail_not_found("builtin", name, &list, &guess);
    return -1;
}

static int open_builtin(int index, hnbrdf_measured **measured)
{
    hnbrdf_error error;
    if (index < 0)
        return CLI_FAILURE;
    if (hnbrdf_measured_open_builtin(index, measured, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    return CLI_OK;
}

/* ---- Recognising files ----------------------------------------------------------------------- */

static int is_directory(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/* For a path that does not exist: a built-in material may have been meant. */
static int fail_missing(const char *path)
{
    int reason = errno;
    const char *name;
    for (int k = 0; (name = hnbrdf_measured_builtin_name(k)); k++)
        if (strcmp(name, path) == 0)
            return cli_fail("%s: %s; the built-in material of that name is builtin:%s", path,
                            strerror(reason), path);
    return cli_fail("%s: %s", path, strerror(reason));
}

/* Is it the name of a material that lies in several files? */
static int is_in_parts(const char *path)
{
    const hnbrdf_measured_format_info *info;
    size_t size = strlen(path) + 32;
    char *part = malloc(size);
    int found = 0;
    for (int row = 0; part && (info = hnbrdf_measured_format_at(row)); row++)
        for (int k = 0; info->part_endings && info->part_endings[k] && !found; k++) {
            struct stat status;
            snprintf(part, size, "%s%s", path, info->part_endings[k]);
            found = stat(part, &status) == 0;
        }
    free(part);
    return found;
}

static int open_measured_file(const char *path, hnbrdf_measured **measured)
{
    hnbrdf_error error;
    struct stat status;
    if (stat(path, &status) != 0) {
        int reason = errno;
        if (!is_in_parts(path)) {
            errno = reason;
            return fail_missing(path);
        }
    }
    if (cli_check_read(path) != CLI_OK)
        return CLI_FAILURE;
    if (hnbrdf_ends_with(path, ".brdf"))
        return cli_fail("%s: a published shader; make a model of it first: hnbrdf import", path);
    if (hnbrdf_measured_open(path, &cli_read, measured, &error) == HNBRDF_OK)
        return CLI_OK;
    return cli_fail("%s", error.text);
}

/* ---- DATA ------------------------------------------------------------------------------------ */

/* The data while they are opened: where each item came from, to name both when two have one name.
 * */
typedef struct data_builder {
    cli_data data;
    char **origins;
    int capacity;
    int rank, ranks; /* this rank opens each ranks-th of them; ranks 0: it opens all */
} data_builder;

static int reserve(data_builder *builder)
{
    if (builder->data.count < builder->capacity)
        return CLI_OK;
    int capacity = builder->capacity ? 2 * builder->capacity : 16;
    hnbrdf_measured **items =
        realloc(builder->data.items, (size_t)capacity * sizeof(hnbrdf_measured *));
    if (items)
        builder->data.items = items;
    char **origins = realloc(builder->origins, (size_t)capacity * sizeof(char *));
    if (origins)
        builder->origins = origins;
    if (!items || !origins)
        return cli_fail("out of memory");
    builder->capacity = capacity;
    return CLI_OK;
}

/* Takes the material over, also on failure. */
static int add_material(data_builder *builder, hnbrdf_measured *measured, const char *origin)
{
    const char *name = hnbrdf_measured_name(measured);
    int result = reserve(builder);
    for (int k = 0; result == CLI_OK && k < builder->data.count; k++)
        if (builder->data.items[k] &&
            strcmp(hnbrdf_measured_name(builder->data.items[k]), name) == 0)
            result = cli_fail("two materials have the name %s: %s and %s", name,
                              builder->origins[k], origin);
    char *copy = result == CLI_OK ? strdup(origin) : NULL;
    if (result == CLI_OK && !copy)
        result = cli_fail("out of memory");
    if (result != CLI_OK) {
        hnbrdf_measured_close(measured);
        return result;
    }
    builder->origins[builder->data.count] = copy;
    builder->data.items[builder->data.count++] = measured;
    return CLI_OK;
}

/* Is the next one another rank's to open? */
static int is_elsewhere(const data_builder *builder)
{
    return builder->ranks > 1 && builder->data.count % builder->ranks != builder->rank;
}

static int leave_out(data_builder *builder)
{
    if (reserve(builder) != CLI_OK)
        return CLI_FAILURE;
    builder->origins[builder->data.count] = NULL;
    builder->data.items[builder->data.count++] = NULL;
    return CLI_OK;
}

static int add_file(data_builder *builder, const char *path)
{
    hnbrdf_measured *measured = NULL;
    if (is_elsewhere(builder))
        return leave_out(builder);
    if (cli_looks_like_model(path)) {
        char files[256];
        cli_measured_files(files, sizeof files, ", ");
        return cli_fail("%s: a model file, expected measured data (%s)", path, files);
    }
    if (open_measured_file(path, &measured) != CLI_OK)
        return CLI_FAILURE;
    return add_material(builder, measured, path);
}

static int add_builtin(data_builder *builder, int index)
{
    char origin[HNBRDF_MAX_NAME + 16];
    hnbrdf_measured *measured = NULL;
    if (index >= 0 && is_elsewhere(builder))
        return leave_out(builder);
    if (open_builtin(index, &measured) != CLI_OK)
        return CLI_FAILURE;
    snprintf(origin, sizeof origin, "builtin:%s", hnbrdf_measured_builtin_name(index));
    return add_material(builder, measured, origin);
}

static int add_procedural(data_builder *builder, int number)
{
    char origin[40];
    hnbrdf_measured *measured = NULL;
    if (is_elsewhere(builder))
        return leave_out(builder);
    if (open_procedural(number, &measured) != CLI_OK)
        return CLI_FAILURE;
    snprintf(origin, sizeof origin, "builtin:procedural-%d", number);
    return add_material(builder, measured, origin);
}

/* The first `count` of them. */
static int add_procedurals(data_builder *builder, const char *count)
{
    char *end;
    const long wanted = strtol(count, &end, 10);
    if (*count < '0' || *count > '9' || *end || wanted < 1 || wanted > HNBRDF_MAX_PROCEDURAL)
        return cli_fail("procedural:%s: expected a number of materials, 1 to %d", count,
                        HNBRDF_MAX_PROCEDURAL);
    for (int k = 0; k < (int)wanted; k++)
        if (add_procedural(builder, k) != CLI_OK)
            return CLI_FAILURE;
    return CLI_OK;
}

static int is_measured_name(const struct dirent *entry)
{
    return hnbrdf_measured_format_of_file(entry->d_name, NULL, NULL) != NULL;
}

static int compare_bytes(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

/* Of a material in several files the first that is there, in the order of its format, stands for
 * all. */
static int is_further_part(struct dirent **entries, int count, int index)
{
    const char *name = entries[index]->d_name;
    size_t stem, other_stem;
    int part, other_part;
    const hnbrdf_measured_format_info *info = hnbrdf_measured_format_of_file(name, &stem, &part);
    for (int k = 0; part > 0 && k < count; k++) {
        const char *other = entries[k]->d_name;
        if (hnbrdf_measured_format_of_file(other, &other_stem, &other_part) == info &&
            other_part >= 0 && other_part < part && other_stem == stem &&
            strncmp(name, other, stem) == 0)
            return 1;
    }
    return 0;
}

static int add_directory(data_builder *builder, const char *path)
{
    struct dirent **entries = NULL;
    int count = scandir(path, &entries, is_measured_name, compare_bytes);
    if (count < 0)
        return cli_fail("%s: cannot read the directory: %s", path, strerror(errno));
    int result = CLI_OK;
    if (count == 0) {
        char files[256];
        cli_measured_files(files, sizeof files, " or ");
        result = cli_fail("%s: the directory has no measured file: %s", path, files);
    }
    const char *slash = hnbrdf_ends_with(path, "/") ? "" : "/";
    for (int k = 0; k < count; k++) {
        size_t size = strlen(path) + strlen(entries[k]->d_name) + 2;
        int wanted = result == CLI_OK && !is_further_part(entries, count, k);
        char *file = wanted ? malloc(size) : NULL;
        if (file) {
            snprintf(file, size, "%s%s%s", path, slash, entries[k]->d_name);
            result = add_file(builder, file);
        } else if (wanted) {
            result = cli_fail("out of memory");
        }
        free(file);
    }
    for (int k = 0; k < count; k++)
        free(entries[k]);
    free(entries);
    return result;
}

static const char *procedural_count(const char *argument)
{
    return strncmp(argument, "procedural:", 11) == 0 ? argument + 11 : NULL;
}

int cli_is_collection(const char *argument)
{
    int first, count;
    return is_builtin_set(argument, &first, &count) || procedural_count(argument) ||
           is_directory(argument);
}

static int add_argument(data_builder *builder, const char *argument)
{
    const char *name = builtin_name_in(argument);
    int first, count;
    if (is_builtin_set(argument, &first, &count)) {
        for (int k = first; k < first + count; k++)
            if (add_builtin(builder, k) != CLI_OK)
                return CLI_FAILURE;
        return CLI_OK;
    }
    if (name && procedural_number(name) >= 0)
        return add_procedural(builder, procedural_number(name));
    if (name)
        return add_builtin(builder, find_builtin(name));
    if (procedural_count(argument))
        return add_procedurals(builder, procedural_count(argument));
    return is_directory(argument) ? add_directory(builder, argument) : add_file(builder, argument);
}

static int open_data(data_builder builder, char *const *arguments, int count, cli_data *data)
{
    int result = count > 0 ? CLI_OK : cli_fail("no data: name files, directories or builtin");
    for (int k = 0; k < count && result == CLI_OK; k++)
        result = add_argument(&builder, arguments[k]);
    for (int k = 0; k < builder.data.count; k++)
        free(builder.origins[k]);
    free(builder.origins);
    if (result == CLI_OK)
        *data = builder.data;
    else
        cli_close_data(&builder.data);
    return result;
}

int cli_open_data(char *const *arguments, int count, cli_data *data)
{
    return open_data((data_builder){0}, arguments, count, data);
}

int cli_open_data_of_ranks(char *const *arguments, int count, cli_data *data)
{
    const data_builder builder = {.rank = cli_rank(), .ranks = cli_rank_count()};
    const int own = open_data(builder, arguments, count, data), code = cli_ranks_agree(own);
    if (code && !own)
        cli_close_data(data);
    return code;
}

void cli_close_data(cli_data *data)
{
    for (int k = 0; k < data->count; k++)
        hnbrdf_measured_close(data->items[k]);
    free(data->items);
    data->items = NULL;
    data->count = 0;
}

/* ---- SOURCE ---------------------------------------------------------------------------------- */

cli_word cli_variant = {HNBRDF_VARIANT_AUTO, cli_variant_word};

/* The shipped network, in the command itself; src/tools.cmake says which. */
extern const unsigned char hnbrdf_universal_model[];
extern const int hnbrdf_universal_model_size;

int cli_is_universal(const char *path)
{
    return strcmp(path, "universal") == 0;
}

static int load_model(const char *path, hnbrdf_model **model)
{
    hnbrdf_error error;
    const hnbrdf_load_options load = {.variant = (hnbrdf_variant)cli_variant.value,
                                      .notes = CLI_NOTES};
    const hnbrdf_result result =
        cli_is_universal(path)
            ? hnbrdf_model_load_memory(hnbrdf_universal_model, (size_t)hnbrdf_universal_model_size,
                                       &load, model, &error)
            : hnbrdf_model_load(path, &load, model, &error);
    return result ? cli_fail("%s", error.text) : CLI_OK;
}

int cli_open_source(const char *path, cli_source *source)
{
    cli_source opened = {0};
    const char *builtin = builtin_name_in(path);
    int result, first, count;
    if (is_builtin_set(path, &first, &count))
        return cli_fail("%s holds %d materials, choose one as in builtin:%s", path, count,
                        hnbrdf_measured_builtin_name(first));
    if (builtin && procedural_number(builtin) >= 0)
        result = open_procedural(procedural_number(builtin), &opened.measured);
    else if (builtin)
        result = open_builtin(find_builtin(builtin), &opened.measured);
    else if (procedural_count(path))
        return cli_fail("%s: materials, choose one as in builtin:procedural-0", path);
    else if (!cli_is_universal(path) && is_directory(path))
        return cli_fail("%s: a directory, expected one model or measured file", path);
    else if (cli_is_universal(path) || cli_looks_like_model(path) ||
             hnbrdf_ends_with(path, ".safetensors"))
        result = load_model(path, &opened.model);
    else
        result = open_measured_file(path, &opened.measured);
    if (result == CLI_OK)
        *source = opened;
    return result;
}

void cli_close_source(cli_source *source)
{
    hnbrdf_model_free(source->model);
    hnbrdf_measured_close(source->measured);
    source->model = NULL;
    source->measured = NULL;
}

int cli_open_model(const char *path, hnbrdf_model **model)
{
    cli_source source;
    if (cli_open_source(path, &source) != CLI_OK)
        return CLI_FAILURE;
    if (!source.model) {
        cli_close_source(&source);
        return cli_fail("%s: measured data, expected a model file", path);
    }
    *model = source.model;
    return CLI_OK;
}

int cli_open_model_to_change(const char *path, const char *output, hnbrdf_model **model)
{
    if (cli_open_model(path, model) != CLI_OK)
        return CLI_FAILURE;
    if (cli_output_check(output) == CLI_OK)
        return CLI_OK;
    hnbrdf_model_free(*model);
    return CLI_FAILURE;
}

int cli_fail_name_taken(const char *path, const char *name)
{
    return cli_fail("%s: there is a material %s already (--replace overwrites it)", path, name);
}

/* ---- Materials of a source ------------------------------------------------------------------- */

int cli_choose_material(const hnbrdf_model *model, const char *name)
{
    int count = hnbrdf_model_material_count(model);
    name_list list = {0};
    hnbrdf_guess guess;
    if (!name && count == 1)
        return 0;
    int index = name ? hnbrdf_model_find(model, name) : -1;
    if (index >= 0)
        return index;
    hnbrdf_guess_begin(&guess, name ? name : "");
    for (int k = 0; k < count; k++) {
        list_name(&list, hnbrdf_model_material_name(model, k));
        hnbrdf_guess_offer(&guess, hnbrdf_model_material_name(model, k));
    }
    if (name)
        fail_not_found("the model", name, &list, &guess);
    else
        cli_fail("the model has %d materials, choose one with --material: %s", count,
                 finish_list(&list));
    return -1;
}

int cli_choose_source_material(const cli_source *source, const char *name)
{
    if (source->model)
        return cli_choose_material(source->model, name);
    const char *only = hnbrdf_measured_name(source->measured);
    if (!name || strcmp(name, only) == 0)
        return 0;
    cli_fail("no material '%.*s' in the measured file; it holds %s", HNBRDF_MAX_NAME, name, only);
    return -1;
}

/* One part of "A,B,C" from `from` on to an index; *next is behind its comma, or NULL at the end. */
static int choose_listed(const hnbrdf_model *model, const char *from, const char **next)
{
    size_t length = strcspn(from, ",");
    char name[HNBRDF_MAX_NAME + 2]; /* one longer than any name, so that a cut one is never found */
    snprintf(name, sizeof name, "%.*s", length < sizeof name ? (int)length : (int)sizeof name - 1,
             from);
    *next = from[length] == ',' ? from + length + 1 : NULL;
    return cli_choose_material(model, name);
}

int cli_choose_materials(const hnbrdf_model *model, const char *list, int **indices, int *count)
{
    int all = hnbrdf_model_material_count(model), n = 0;
    int *chosen = malloc((size_t)all * sizeof *chosen);
    if (!chosen)
        return cli_fail("out of memory");
    for (; !list && n < all; n++)
        chosen[n] = n;
    /* A name may hold commas itself. */
    if (list && hnbrdf_model_find(model, list) >= 0) {
        chosen[n++] = hnbrdf_model_find(model, list);
        list = NULL;
    }
    while (list) {
        int index = choose_listed(model, list, &list);
        for (int k = 0; k < n && index >= 0; k++)
            if (chosen[k] == index) {
                cli_fail("the material %s is named twice",
                         hnbrdf_model_material_name(model, index));
                index = -1;
            }
        if (index < 0) {
            free(chosen);
            return CLI_FAILURE;
        }
        chosen[n++] = index;
    }
    *indices = chosen;
    *count = n;
    return CLI_OK;
}
