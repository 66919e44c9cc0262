/* exchange_out.c: hands out an exported scene, what to run it on and how. */
#include "check/exchange.h"

#include "base/error.h"
#include "base/files.h"
#include "base/text_buffer.h"
#include "base/write.h"
#include "check/parity.h"
#include "check/probe.h"
#include "glsl/export_language.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The texts of shaders/parity.glsl and shaders/probe.glsl. */
extern const char hnbrdf_parity_glsl[], hnbrdf_probe_glsl[];

/* ---- Names and texts ------------------------------------------------------------------------- */

void check_exchange_name(const check_exchange *exchange, const char *name, check_build build,
                         char to[64])
{
    snprintf(to, 64, "%s%s.%s", name, build == CHECK_BUILD_EXACT ? "_exact" : "",
             hnbrdf_shading_language_name(exchange->options.language));
}

hnbrdf_result check_exchange_path(const char *folder, const char *name,
                                  char path[CHECK_EXCHANGE_PATH], hnbrdf_error *error)
{
    int length = snprintf(path, CHECK_EXCHANGE_PATH, "%s/%s", folder, name);
    return length > 0 && length < CHECK_EXCHANGE_PATH
               ? HNBRDF_OK
               : hnbrdf_fail(error, HNBRDF_ERROR_IO, "%s: the path is too long", folder);
}

/* Bytes without fail; the text of the buffer or an error. */
static hnbrdf_result take(hnbrdf_text_buffer *buffer, char **text, hnbrdf_error *error)
{
    *text = hnbrdf_text_buffer_take(buffer);
    return *text ? HNBRDF_OK : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "verify: out of memory");
}

hnbrdf_result check_exchange_scene(const hnbrdf_model *model, const check_exchange *exchange,
                                   check_build build, char **text, hnbrdf_error *error)
{
    hnbrdf_text_buffer buffer = {0};
    hnbrdf_glsl_options options = exchange->options;
    options.materials = exchange->check.materials;
    options.material_count = exchange->check.material_count;
    options.standalone = 1;
    options.exact = build == CHECK_BUILD_EXACT;
    hnbrdf_result result =
        hnbrdf_export_shader(model, &options, hnbrdf_text_buffer_append, &buffer, error);
    if (result) {
        free(buffer.bytes);
        return result;
    }
    return take(&buffer, text, error);
}

/* shaders/parity.glsl and shaders/probe.glsl in the language of the scene. */
static hnbrdf_result parity_text(const hnbrdf_model *model, const check_exchange *exchange,
                                 check_build build, char **text, hnbrdf_error *error)
{
    hnbrdf_text_buffer glsl = {0}, buffer = {0};
    char *body = NULL;
    hnbrdf_glsl_options options = exchange->options;
    options.materials = exchange->check.materials;
    options.material_count = exchange->check.material_count;
    options.exact = build == CHECK_BUILD_EXACT;
    hnbrdf_text_buffer_append(&glsl, hnbrdf_parity_glsl, strlen(hnbrdf_parity_glsl));
    hnbrdf_text_buffer_append(&glsl, "\n", 1);
    hnbrdf_text_buffer_append(&glsl, hnbrdf_probe_glsl, strlen(hnbrdf_probe_glsl));
    hnbrdf_result result = take(&glsl, &body, error);
    if (!result)
        result = hnbrdf_export_behind(model, &options, "parity.glsl", body,
                                      hnbrdf_text_buffer_append, &buffer, error);
    free(body);
    if (!result)
        return take(&buffer, text, error);
    free(buffer.bytes);
    return result;
}

/* ---- Files ----------------------------------------------------------------------------------- */

static hnbrdf_result write_text(const check_exchange *exchange, const char *name, check_build build,
                                const char *text, hnbrdf_error *error)
{
    char path[CHECK_EXCHANGE_PATH], file[64];
    check_exchange_name(exchange, name, build, file);
    hnbrdf_result result = check_exchange_path(exchange->folder, file, path, error);
    return result ? result : hnbrdf_write_file(path, text, strlen(text), error);
}

static hnbrdf_result write_texts(const hnbrdf_model *model, const check_exchange *exchange,
                                 hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int b = 0; b < CHECK_BUILDS && !result; b++) {
        const check_build build = (check_build)b;
        char *scene = NULL, *parity = NULL;
        result = check_exchange_scene(model, exchange, build, &scene, error);
        if (!result)
            result = parity_text(model, exchange, build, &parity, error);
        if (!result)
            result = write_text(exchange, "scene", build, scene, error);
        if (!result)
            result = write_text(exchange, "parity", build, parity, error);
        free(scene);
        free(parity);
    }
    return result;
}

static void put_floats(FILE *file, const float *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, numbers + i, sizeof bits);
        const unsigned char bytes[4] = {(unsigned char)bits, (unsigned char)(bits >> 8),
                                        (unsigned char)(bits >> 16), (unsigned char)(bits >> 24)};
        fwrite(bytes, 1, sizeof bytes, file); /* closing tells whether it failed */
    }
}

static hnbrdf_result put_rows(const hnbrdf_model *model, const check_exchange *exchange, FILE *file,
                              hnbrdf_error *error)
{
    const check_verify_options *check = &exchange->check;
    check_reference reference;
    hnbrdf_result result = check_reference_open(check->pairs, check->precision, &reference, error);
    float(*rows)[CHECK_PARITY_INPUTS] = calloc(check->pairs, sizeof *rows);
    if (!result && !rows)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "verify: out of memory");
    for (int k = 0; k < check->material_count && !result; k++) {
        check_material_rows(model, check, k, &reference, rows);
        put_floats(file, rows[0], check->pairs * CHECK_PARITY_INPUTS);
    }
    free(rows);
    check_reference_close(&reference);
    return result;
}

static hnbrdf_result write_inputs(const hnbrdf_model *model, const check_exchange *exchange,
                                  hnbrdf_error *error)
{
    char path[CHECK_EXCHANGE_PATH];
    hnbrdf_output output;
    hnbrdf_result result = check_exchange_path(exchange->folder, "inputs.f32", path, error);
    if (!result)
        result = hnbrdf_output_open(path, &output, error);
    if (result)
        return result;
    result = put_rows(model, exchange, output.stream, error);
    if (!result)
        return hnbrdf_output_close(&output, error);
    hnbrdf_output_discard(&output);
    return result;
}

static hnbrdf_result write_probe(const check_exchange *exchange, hnbrdf_error *error)
{
    char path[CHECK_EXCHANGE_PATH];
    hnbrdf_output output;
    float(*operands)[CHECK_PROBE_OPERANDS] = calloc(CHECK_PROBE_COUNT, sizeof *operands);
    if (!operands)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "verify: out of memory");
    check_probe_draw(operands, CHECK_PROBE_COUNT);
    hnbrdf_result result = check_exchange_path(exchange->folder, "probe.f32", path, error);
    if (!result)
        result = hnbrdf_output_open(path, &output, error);
    if (!result) {
        put_floats(output.stream, operands[0], CHECK_PROBE_COUNT * CHECK_PROBE_OPERANDS);
        result = hnbrdf_output_close(&output, error);
    }
    free(operands);
    return result;
}

static hnbrdf_result write_weights(const hnbrdf_model *model, const check_exchange *exchange,
                                   hnbrdf_error *error)
{
    char path[CHECK_EXCHANGE_PATH];
    hnbrdf_text_buffer block = {0};
    if (exchange->options.weights != HNBRDF_GLSL_UNIFORM || hnbrdf_weights_size(model) == 0)
        return HNBRDF_OK;
    hnbrdf_result result = check_exchange_path(exchange->folder, "weights.bin", path, error);
    if (!result)
        result = hnbrdf_export_weights(model, &exchange->options, hnbrdf_text_buffer_append, &block,
                                       error);
    if (!result)
        result = hnbrdf_write_file(path, block.bytes, block.size, error);
    free(block.bytes);
    return result;
}

/* ---- What is in the folder ------------------------------------------------------------------- */

static void put_case(const hnbrdf_model *model, const check_exchange *exchange, FILE *file)
{
    const check_verify_options *check = &exchange->check;
    const hnbrdf_glsl_options *options = &exchange->options;
    const size_t rows = check->pairs * (size_t)check->material_count;
    size_t weights = options->weights == HNBRDF_GLSL_UNIFORM ? hnbrdf_weights_size(model) : 0;
    fprintf(file,
            "{\"format\": \"hnbrdf-parity/1\",\n \"language\": \"%s\", \"extension\": \"%s\",\n",
            hnbrdf_shading_language_name(options->language),
            hnbrdf_shading_language_name(options->language));
    fprintf(file,
            " \"weights\": \"%s\", \"precision\": \"%s\", \"fixed\": %d, \"editable\": %d,\n"
            " \"weights_bytes\": %zu,\n",
            hnbrdf_glsl_weights_name(options->weights),
            hnbrdf_glsl_precision_name(options->precision), options->fixed, options->editable,
            weights);
    fprintf(file,
            " \"rows\": %zu, \"inputs_per_row\": %d, \"slots\": %d, \"outputs_per_row\": %d,\n"
            " \"probe_rows\": %d, \"probe_inputs_per_row\": %d, \"probe_slots\": %d,"
            " \"probe_outputs_per_row\": %d,\n",
            rows, CHECK_PARITY_INPUTS, CHECK_PARITY_SLOTS, CHECK_PARITY_OUTPUTS, CHECK_PROBE_COUNT,
            CHECK_PROBE_OPERANDS, CHECK_PROBE_RESULTS / 4, CHECK_PROBE_RESULTS);
    fprintf(file, " \"pairs\": %zu, \"seed\": %llu,\n \"materials\": [", check->pairs,
            (unsigned long long)check->seed);
    for (int k = 0; k < check->material_count; k++) {
        fputs(k ? ", " : "", file);
        hnbrdf_write_json_text(file, hnbrdf_model_material_name(model, check->materials[k]));
    }
    fputs("]}\n", file);
}

static hnbrdf_result write_case(const hnbrdf_model *model, const check_exchange *exchange,
                                hnbrdf_error *error)
{
    char path[CHECK_EXCHANGE_PATH];
    hnbrdf_output output;
    hnbrdf_result result = check_exchange_path(exchange->folder, "case.json", path, error);
    if (!result)
        result = hnbrdf_output_open(path, &output, error);
    if (result)
        return result;
    put_case(model, exchange, output.stream);
    return hnbrdf_output_close(&output, error);
}

hnbrdf_result check_hand_out(const hnbrdf_model *model, const check_exchange *exchange,
                             hnbrdf_error *error)
{
    hnbrdf_result result = write_texts(model, exchange, error);
    if (!result)
        result = write_inputs(model, exchange, error);
    if (!result)
        result = write_probe(exchange, error);
    if (!result)
        result = write_weights(model, exchange, error);
    return result ? result : write_case(model, exchange, error);
}
