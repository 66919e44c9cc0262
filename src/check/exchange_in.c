/* exchange_in.c: reads what a program made of a folder, and judges it. */
#include "check/exchange.h"

#include "base/bytes.h"
#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "check/probe.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CASE_BYTES = 1 << 20 };

typedef struct reader {
    const hnbrdf_model *model;
    const char *folder;
    check_handed_in *found;
    char path[CHECK_EXCHANGE_PATH]; /* of the file that is read */
    FILE *inputs, *outputs[CHECK_BUILDS];
} reader;

static hnbrdf_result format_error(const reader *r, const char *what, hnbrdf_error *error)
{
    return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: %s", r->path, what);
}

/* The whole file, NUL-terminated, of at most `most` bytes. */
static hnbrdf_result read_text(reader *r, const char *name, size_t most, char **text,
                               hnbrdf_error *error)
{
    hnbrdf_result result = check_exchange_path(r->folder, name, r->path, error);
    FILE *file = result ? NULL : hnbrdf_open_whole(r->path, r->path, error);
    if (!file)
        return result ? result : HNBRDF_ERROR_IO;
    char *bytes = malloc(most + 1);
    size_t size = bytes ? fread(bytes, 1, most + 1, file) : 0;
    int failed = ferror(file);
    fclose(file);
    if (bytes && size <= most && !failed) {
        bytes[size] = '\0';
        *text = bytes;
        return HNBRDF_OK;
    }
    free(bytes);
    return format_error(r, "too long, or not to be read", error);
}

/* ---- case.json ------------------------------------------------------------------------------- */

/* The number of a word, as `name` gives the words; -1 for none of them. */
static int word_of(hnbrdf_json_text text, const char *(*name)(int value))
{
    for (int value = 0; name(value); value++)
        if (hnbrdf_json_equals(text, name(value)))
            return value;
    return -1;
}

static const char *language_word(int value)
{
    return hnbrdf_shading_language_name((hnbrdf_shading_language)value);
}

static const char *weights_word(int value)
{
    return hnbrdf_glsl_weights_name((hnbrdf_glsl_weights)value);
}

static const char *precision_word(int value)
{
    return hnbrdf_glsl_precision_name((hnbrdf_glsl_precision)value);
}

static int read_word(hnbrdf_json *json, const char *(*name)(int value), const char *expected)
{
    const char *at = json->at;
    hnbrdf_json_text text;
    int value = hnbrdf_json_string(json, &text) ? word_of(text, name) : 0;
    if (value < 0)
        hnbrdf_json_fail(json, at, expected);
    return value < 0 ? 0 : value;
}

static uint64_t read_number(hnbrdf_json *json, uint64_t least, uint64_t most, const char *expected)
{
    const char *at = json->at;
    uint64_t value = least;
    if (hnbrdf_json_integer(json, &value) && (value < least || value > most))
        hnbrdf_json_fail(json, at, expected);
    return value;
}

static void read_materials(reader *r, hnbrdf_json *json)
{
    check_verify_options *check = &r->found->exchange.check;
    hnbrdf_json_text text;
    check->material_count = 0;
    if (!hnbrdf_json_open(json, '['))
        return;
    while (hnbrdf_json_more(json, ']')) {
        const char *at = json->at;
        if (!hnbrdf_json_string(json, &text))
            return;
        int index = 0, count = hnbrdf_model_material_count(r->model);
        while (index < count &&
               !hnbrdf_json_equals(text, hnbrdf_model_material_name(r->model, index)))
            index++;
        if (index == count || check->material_count == count) {
            hnbrdf_json_fail(json, at, "a material of this model");
            return;
        }
        r->found->materials[check->material_count++] = index;
    }
}

static void read_field(reader *r, hnbrdf_json *json, hnbrdf_json_text key, int *is_ours)
{
    hnbrdf_glsl_options *options = &r->found->exchange.options;
    check_verify_options *check = &r->found->exchange.check;
    hnbrdf_json_text text;
    if (hnbrdf_json_equals(key, "format"))
        *is_ours = hnbrdf_json_string(json, &text) && hnbrdf_json_equals(text, "hnbrdf-parity/1");
    else if (hnbrdf_json_equals(key, "language"))
        options->language =
            (hnbrdf_shading_language)read_word(json, language_word, "a shading language");
    else if (hnbrdf_json_equals(key, "weights"))
        options->weights =
            (hnbrdf_glsl_weights)read_word(json, weights_word, "constants, columns or uniform");
    else if (hnbrdf_json_equals(key, "precision"))
        options->precision =
            (hnbrdf_glsl_precision)read_word(json, precision_word, "float or half");
    else if (hnbrdf_json_equals(key, "fixed"))
        options->fixed = (int)read_number(json, 0, 1, "0 or 1");
    else if (hnbrdf_json_equals(key, "editable"))
        options->editable = (int)read_number(json, 0, 1, "0 or 1");
    else if (hnbrdf_json_equals(key, "pairs"))
        check->pairs = (size_t)read_number(json, 1, 1 << 22, "1 to 4194304");
    else if (hnbrdf_json_equals(key, "seed"))
        check->seed = read_number(json, 0, UINT64_MAX, "a whole number");
    else if (hnbrdf_json_equals(key, "materials"))
        read_materials(r, json);
    else
        hnbrdf_json_skip(json);
}

static hnbrdf_result read_case(reader *r, hnbrdf_error *error)
{
    hnbrdf_json json;
    hnbrdf_json_text key;
    char *text = NULL;
    int is_ours = 0;
    check_handed_in *found = r->found;
    hnbrdf_result result = read_text(r, "case.json", CASE_BYTES, &text, error);
    if (result)
        return result;
    found->materials =
        calloc((size_t)hnbrdf_model_material_count(r->model), sizeof *found->materials);
    if (!found->materials) {
        free(text);
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "verify: out of memory");
    }
    found->exchange.check.materials = found->materials;
    hnbrdf_json_begin(&json, text, strlen(text));
    if (hnbrdf_json_open(&json, '{'))
        while (hnbrdf_json_more(&json, '}') && hnbrdf_json_key(&json, &key))
            read_field(r, &json, key, &is_ours);
    hnbrdf_json_finish(&json);
    found->exchange.check.precision = found->exchange.options.precision;
    if (json.expected)
        result = hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: at byte %zu: expected %s", r->path,
                             (size_t)(json.at - text), json.expected);
    else if (!is_ours || found->exchange.check.pairs == 0 ||
             found->exchange.check.material_count == 0)
        result = format_error(r, "not written by hnbrdf verify --hand-out", error);
    free(text);
    return result;
}

/* ---- The other files ------------------------------------------------------------------------- */

/* What this model gives now is what was handed out: the numbers are of this shader. */
static hnbrdf_result check_scene(reader *r, check_build build, hnbrdf_error *error)
{
    char name[64], *now = NULL, *then = NULL;
    check_exchange_name(&r->found->exchange, "scene", build, name);
    hnbrdf_result result = check_exchange_scene(r->model, &r->found->exchange, build, &now, error);
    if (!result)
        result = read_text(r, name, strlen(now), &then, error);
    if (!result && strcmp(now, then) != 0)
        result = format_error(r, "not what this model exports now: hand it out again", error);
    free(now);
    free(then);
    return result;
}

static const char *device_line(reader *r)
{
    char *text = NULL;
    char *name = r->found->device;
    strcpy(name, "a program");
    if (read_text(r, "device.txt", CASE_BYTES, &text, NULL))
        return name;
    size_t length = strcspn(text, "\r\n");
    if (length > 0)
        snprintf(name, CHECK_DEVICE_NAME, "%.*s", (int)(length < 120 ? length : 120), text);
    for (char *c = name; *c; c++)
        if ((unsigned char)*c < ' ')
            *c = ' ';
    free(text);
    return name;
}

/* Opens a file of so many floats. */
static hnbrdf_result open_floats(reader *r, const char *name, size_t rows, size_t width,
                                 FILE **opened, hnbrdf_error *error)
{
    hnbrdf_result result = check_exchange_path(r->folder, name, r->path, error);
    FILE *file = result ? NULL : hnbrdf_open_whole(r->path, r->path, error);
    if (!file)
        return result ? result : HNBRDF_ERROR_IO;
    long size = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    if (size == (long)(rows * width * 4) && fseek(file, 0, SEEK_SET) == 0) {
        *opened = file;
        return HNBRDF_OK;
    }
    fclose(file);
    return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                       "%s: %ld bytes, expected %zu: %zu rows of %zu floats", r->path, size,
                       rows * width * 4, rows, width);
}

static hnbrdf_result read_floats(reader *r, FILE *file, const char *name, float *to, size_t count,
                                 hnbrdf_error *error)
{
    const size_t step = 1 << 14;
    unsigned char bytes[4 * (1 << 14)];
    for (size_t done = 0; done < count;) {
        size_t now = count - done < step ? count - done : step;
        if (fread(bytes, 4, now, file) != now) {
            check_exchange_path(r->folder, name, r->path, NULL);
            return format_error(r, "cannot be read", error);
        }
        for (size_t i = 0; i < now; i++)
            to[done + i] = le_float(bytes + 4 * i);
        done += now;
    }
    return HNBRDF_OK;
}

/* ---- As a device ----------------------------------------------------------------------------- */

static const char *const OUTPUTS[CHECK_BUILDS] = {"outputs_exact.f32", "outputs.f32"};

static int is_llvmpipe(const char *device)
{
    return strstr(device, "llvmpipe") != NULL;
}

static hnbrdf_result probe(void *user, check_arithmetic *arithmetic, hnbrdf_error *error)
{
    reader *r = user;
    const size_t count = CHECK_PROBE_COUNT;
    FILE *file = NULL;
    float(*operands)[CHECK_PROBE_OPERANDS] = calloc(count, sizeof *operands);
    float(*results)[CHECK_PROBE_RESULTS] = calloc(count, sizeof *results);
    hnbrdf_result result =
        operands && results
            ? open_floats(r, "probe_results.f32", count, CHECK_PROBE_RESULTS, &file, error)
            : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "verify: out of memory");
    if (!result)
        result = read_floats(r, file, "probe_results.f32", results[0], count * CHECK_PROBE_RESULTS,
                             error);
    if (!result) {
        check_probe_draw(operands, (int)count);
        check_probe_judge((const float(*)[CHECK_PROBE_OPERANDS])operands,
                          (const float(*)[CHECK_PROBE_RESULTS])results, (int)count,
                          is_llvmpipe(r->found->device), arithmetic);
    }
    if (file)
        fclose(file);
    free(operands);
    free(results);
    return result;
}

/* Every way to be no number counts as one: a machine may choose another. */
static int same_rows(const float *a, const float *b, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (memcmp(a + i, b + i, sizeof *a) != 0 && !(a[i] != a[i] && b[i] != b[i]))
            return 0;
    return 1;
}

/* The rows handed out are those that would be now; once for both builds. */
static hnbrdf_result check_inputs(reader *r, const float *rows, size_t count, hnbrdf_error *error)
{
    float *then = malloc(count * CHECK_PARITY_INPUTS * sizeof *then);
    if (!then)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "verify: out of memory");
    hnbrdf_result result =
        read_floats(r, r->inputs, "inputs.f32", then, count * CHECK_PARITY_INPUTS, error);
    if (!result && !same_rows(rows, then, count * CHECK_PARITY_INPUTS)) {
        check_exchange_path(r->folder, "inputs.f32", r->path, NULL);
        result = format_error(r, "not what this model gives now: hand it out again", error);
    }
    free(then);
    return result;
}

static hnbrdf_result run(void *user, check_build build, const float *rows, size_t count,
                         float *outputs, int *has_run, hnbrdf_error *error)
{
    reader *r = user;
    hnbrdf_result result = HNBRDF_OK;
    if (build == 0)
        result = check_inputs(r, rows, count, error);
    *has_run = r->outputs[build] != NULL;
    if (!result && *has_run)
        result = read_floats(r, r->outputs[build], OUTPUTS[build], outputs,
                             count * CHECK_PARITY_OUTPUTS, error);
    return result;
}

/* outputs.f32 must be there, outputs_exact.f32 may. */
static hnbrdf_result open_outputs(reader *r, hnbrdf_error *error)
{
    const check_verify_options *check = &r->found->exchange.check;
    const size_t rows = check->pairs * (size_t)check->material_count;
    hnbrdf_result result =
        open_floats(r, "inputs.f32", rows, CHECK_PARITY_INPUTS, &r->inputs, error);
    for (int build = CHECK_BUILDS - 1; build >= 0 && !result; build--) {
        result =
            open_floats(r, OUTPUTS[build], rows, CHECK_PARITY_OUTPUTS, &r->outputs[build], error);
        if (result == HNBRDF_ERROR_IO && build == CHECK_BUILD_EXACT)
            result = HNBRDF_OK;
    }
    return result;
}

static hnbrdf_result judge(reader *r, hnbrdf_error *error)
{
    check_handed_in *found = r->found;
    hnbrdf_result result = read_case(r, error);
    for (int build = 0; build < CHECK_BUILDS && !result; build++)
        result = check_scene(r, (check_build)build, error);
    if (!result)
        result = open_outputs(r, error);
    if (result)
        return result;
    const check_runner runner = {
        .is_llvmpipe = is_llvmpipe(device_line(r)), .probe = probe, .run = run, .user = r};
    return check_verify(&runner, r->model, &found->exchange.check, &found->report, error);
}

hnbrdf_result check_hand_in(const hnbrdf_model *model, const char *folder,
                            void (*progress)(void *user, double share), void *user,
                            check_handed_in *found, hnbrdf_error *error)
{
    memset(found, 0, sizeof *found);
    found->exchange =
        (check_exchange){.folder = folder, .check = {.progress = progress, .progress_user = user}};
    reader r = {.model = model, .folder = folder, .found = found};
    hnbrdf_result result = judge(&r, error);
    if (r.inputs)
        fclose(r.inputs);
    for (int build = 0; build < CHECK_BUILDS; build++)
        if (r.outputs[build])
            fclose(r.outputs[build]);
    if (result)
        check_handed_in_free(found);
    return result;
}

void check_handed_in_free(check_handed_in *found)
{
    check_report_free(&found->report);
    free(found->materials);
    memset(found, 0, sizeof *found);
}
