/* import_brdf.c: make a model of the published BRDF-Explorer .brdf files of one dataset.
 * Each holds one material as parameter lines and, written out in GLSL, the network of all. */
#include "base/error.h"
#include "base/foreign.h"
#include "import/brdf_heading.h"
#include "import/brdf_network.h"
#include "import/brdf_parameters.h"
#include "import/brdf_text.h"
#include "base/memory.h"
#include "base/text.h"

#include <string.h>

/* What one file holds. */
typedef struct published {
    hnbrdf_brdf_network network;
    hnbrdf_brdf_heading heading;
    float scale, shift; /* exp(scale c + shift) */
    int has_exponent;
    int latent;
} published;

/* ---- exp(S*(neural_output) + M) -------------------------------------------------------------- */

/* A product of numbers, and of neural_output at most once, each with or without parentheses. */
static hnbrdf_result read_product(hnbrdf_words *words, float *number, int *has_output,
                                  hnbrdf_error *error)
{
    *number = 1;
    *has_output = 0;
    do {
        const int parenthesis = hnbrdf_words_take(words, "(");
        float factor;
        if (hnbrdf_words_take_number(words, &factor))
            *number *= factor;
        else if (!*has_output && hnbrdf_words_take(words, "neural_output"))
            *has_output = 1;
        else
            return hnbrdf_words_fail(words, "a number, or neural_output once", error);
        if (parenthesis && !hnbrdf_words_take(words, ")"))
            return hnbrdf_words_fail(words, "')'", error);
    } while (hnbrdf_words_take(words, "*"));
    return HNBRDF_OK;
}

/* The argument of exp, from behind its parenthesis. */
static hnbrdf_result read_exponent(hnbrdf_words *words, published *p, hnbrdf_error *error)
{
    int has_output = 0;
    if (p->has_exponent)
        return hnbrdf_words_fail(words, "neural_output = exp(...) once", error);
    do {
        int negative = 0, is_output;
        float number;
        while (hnbrdf_words_at(words, "+") || hnbrdf_words_at(words, "-")) {
            negative ^= hnbrdf_words_at(words, "-");
            hnbrdf_words_next(words);
        }
        const hnbrdf_result result = read_product(words, &number, &is_output, error);
        if (result)
            return result;
        *(is_output ? &p->scale : &p->shift) += negative ? -number : number;
        has_output |= is_output;
    } while (hnbrdf_words_at(words, "+") || hnbrdf_words_at(words, "-"));
    if (!hnbrdf_words_at(words, ")") || !has_output)
        return hnbrdf_words_fail(words, "exp(S*(neural_output) + M)", error);
    p->has_exponent = 1;
    return HNBRDF_OK;
}

/* ---- One file -------------------------------------------------------------------------------- */

/* Moves behind the '{' of a function's definition; stays behind the name if this is none. */
static int take_definition(hnbrdf_words *words)
{
    hnbrdf_words ahead = *words;
    if (!hnbrdf_words_take(&ahead, "("))
        return 0;
    while (ahead.kind == HNBRDF_WORD_NAME || ahead.kind == HNBRDF_WORD_NUMBER ||
           hnbrdf_words_at(&ahead, ",") || hnbrdf_words_at(&ahead, "[") ||
           hnbrdf_words_at(&ahead, "]"))
        hnbrdf_words_next(&ahead);
    if (!hnbrdf_words_take(&ahead, ")") || !hnbrdf_words_take(&ahead, "{"))
        return 0;
    *words = ahead;
    return 1;
}

static int take_exponent(hnbrdf_words *words)
{
    hnbrdf_words ahead = *words;
    if (!hnbrdf_words_take(&ahead, "=") || !hnbrdf_words_take(&ahead, "exp") ||
        !hnbrdf_words_take(&ahead, "("))
        return 0;
    *words = ahead;
    return 1;
}

static hnbrdf_result check_network(const char *file, const published *p, hnbrdf_error *error)
{
    const hnbrdf_brdf_network *n = &p->network;
    const int last = n->layers - 1, outputs = p->heading.kind == HNBRDF_KIND_NEURAL ? 3 : 6;
    if (p->heading.kind == HNBRDF_KIND_GGX && last < 0)
        return HNBRDF_OK;
    if (last < 0) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: has no function mlp_eval, expected one",
                           file);
    }
    if (!p->has_exponent) {
        return hnbrdf_fail(
            error, HNBRDF_ERROR_FORMAT,
            "%s: has no line neural_output = exp(S*(neural_output) + M), expected one", file);
    }
    if (last < 1 || n->outputs[last] != outputs || p->heading.kind == HNBRDF_KIND_GGX) {
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: mlp_eval has %d layers and %d outputs, expected %s", file,
                           n->layers, n->outputs[last],
                           p->heading.kind == HNBRDF_KIND_GGX ? "none of a ggx material"
                           : outputs == 3                     ? "at least 2 layers and 3 outputs"
                                          : "at least 2 layers and 6 outputs, correction and gate");
    }
    for (int k = 1; k < last; ++k) {
        if (n->outputs[k] != n->outputs[0]) {
            return hnbrdf_fail(
                error, HNBRDF_ERROR_UNSUPPORTED,
                "%s: mlp_eval has hidden layers of %d and %d units, expected one width", file,
                n->outputs[0], n->outputs[k]);
        }
    }
    if (n->inputs[0] != HNBRDF_ENCODING_SIZE + p->latent) {
        return hnbrdf_fail(
            error, HNBRDF_ERROR_FORMAT,
            "%s: mlp_eval has %d inputs, expected %d: wi, wo and latent_0 to latent_%d", file,
            n->inputs[0], HNBRDF_ENCODING_SIZE + p->latent, p->latent - 1);
    }
    return HNBRDF_OK;
}

/* The text of one material. */
static hnbrdf_result read_words(hnbrdf_words *words, published *p,
                                hnbrdf_brdf_parameters *parameters, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    while (!result && words->kind != HNBRDF_WORD_END) {
        if (hnbrdf_words_take(words, "float")) {
            result = hnbrdf_brdf_read_parameter(words, parameters, error);
        } else if (hnbrdf_words_take(words, "mlp_eval")) {
            if (take_definition(words)) {
                hnbrdf_words body = *words; /* the line with exp may stand in it */
                result = p->network.layers
                             ? hnbrdf_words_fail(words, "one function mlp_eval", error)
                             : hnbrdf_brdf_read_network(&body, &p->network, error);
            }
        } else if (hnbrdf_words_take(words, "neural_output")) {
            if (take_exponent(words))
                result = read_exponent(words, p, error);
        } else {
            hnbrdf_words_next(words);
        }
    }
    return result;
}

/* What is no text of this kind at all is called by its name. */
static hnbrdf_result check_kind(const char *file, const char *text, size_t size,
                                hnbrdf_error *error)
{
    const unsigned char *bytes = (const unsigned char *)text;
    const char *other = hnbrdf_foreign_file(bytes, size);
    if (!other)
        other = hnbrdf_own_file(bytes, size);
    if (!other || hnbrdf_is_brdf_text(bytes, size))
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: %s, expected a published .brdf shader",
                       file, other);
}

static hnbrdf_result read_file(const char *file, const char *text, size_t size, published *p,
                               hnbrdf_brdf_parameters *parameters, hnbrdf_error *error)
{
    hnbrdf_words words;
    hnbrdf_error inner;
    hnbrdf_result result = check_kind(file, text, size, error);
    memset(p, 0, sizeof *p);
    hnbrdf_material_init(parameters->material);
    if (result || (result = hnbrdf_brdf_read_heading(file, text, size, &p->heading, error)))
        return result;
    p->scale = p->heading.present ? p->heading.scale : 0;
    p->shift = p->heading.shift;
    p->has_exponent = p->heading.present;
    parameters->kind = p->heading.kind;
    parameters->has_rotation = p->heading.present;
    hnbrdf_words_begin(&words, file, text, size);
    if ((result = read_words(&words, p, parameters, error)) ||
        (result = hnbrdf_brdf_check_parameters(file, parameters, &p->latent, error)) ||
        (result = check_network(file, p, error)))
        return result;
    if (p->heading.has_fitted)
        parameters->material->fitted = p->heading.fitted;
    if (p->heading.has_lobes)
        parameters->material->lobes = p->heading.lobes;
    parameters->material->energy = p->heading.energy;
    if ((result = hnbrdf_material_check(parameters->material, &inner)))
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: %s", file, inner.text);
    return HNBRDF_OK;
}

/* ---- All files ------------------------------------------------------------------------------- */

/* The first and the current file side by side, and all materials behind them. */
typedef struct importing {
    published first, current;
    hnbrdf_material materials[];
} importing;

typedef struct number_text {
    char text[HNBRDF_NUMBER_TEXT];
} number_text;

static number_text print(float number)
{
    number_text printed;
    hnbrdf_format_float(printed.text, sizeof printed.text, number);
    return printed;
}

static hnbrdf_result compare_exponent(const published *a, const published *b, const char *file,
                                      const char *first, hnbrdf_error *error)
{
    if (a->scale == b->scale && a->shift == b->shift)
        return HNBRDF_OK;
    return hnbrdf_fail(
        error, HNBRDF_ERROR_FORMAT,
        "%s: exp(S*(neural_output) + M) has S %s and M %s, expected %s and %s as in %s", file,
        print(b->scale).text, print(b->shift).text, print(a->scale).text, print(a->shift).text,
        first);
}

static hnbrdf_result compare_numbers(const float *a, const float *b, int count, int columns,
                                     int layer, const char *file, const char *first,
                                     hnbrdf_error *error)
{
    for (int i = 0; i < count; ++i) {
        if (a[i] != b[i]) {
            return hnbrdf_fail(
                error, HNBRDF_ERROR_FORMAT,
                "%s: mlp_eval: layer %d: %s of output %d, input %d is %s, expected %s as in %s",
                file, layer, columns ? "weight" : "bias", columns ? i / columns : i,
                columns ? i % columns : 0, print(b[i]).text, print(a[i]).text, first);
        }
    }
    return HNBRDF_OK;
}

static hnbrdf_result compare_headings(const hnbrdf_brdf_heading *a, const hnbrdf_brdf_heading *b,
                                      const char *file, const char *first, hnbrdf_error *error)
{
    if (a->kind == b->kind && a->encoding == b->encoding && a->floor == b->floor)
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                       "%s: is %s, encoding %s, floor %s, expected %s, %s, %s as in %s", file,
                       hnbrdf_kind_name(b->kind), hnbrdf_encoding_name(b->encoding),
                       print(b->floor).text, hnbrdf_kind_name(a->kind),
                       hnbrdf_encoding_name(a->encoding), print(a->floor).text, first);
}

/* All files of a dataset carry one network. */
static hnbrdf_result compare(const importing *all, const char *file, const char *first,
                             hnbrdf_error *error)
{
    const hnbrdf_brdf_network *a = &all->first.network, *b = &all->current.network;
    hnbrdf_result result =
        compare_headings(&all->first.heading, &all->current.heading, file, first, error);
    if (result)
        return result;
    if (a->layers != b->layers || a->outputs[0] != b->outputs[0] || a->inputs[0] != b->inputs[0]) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: mlp_eval is %dx%d with %d inputs, expected %dx%d with %d as in %s",
                           file, b->outputs[0], b->layers - 1, b->inputs[0], a->outputs[0],
                           a->layers - 1, a->inputs[0], first);
    }
    for (int k = 0; k < a->layers && !result; ++k) {
        const int rows = a->outputs[k], columns = a->inputs[k];
        result = compare_numbers(a->weights[k], b->weights[k], rows * columns, columns, k, file,
                                 first, error);
        if (!result)
            result = compare_numbers(a->biases[k], b->biases[k], rows, 0, k, file, first, error);
    }
    return result ? result : compare_exponent(&all->first, &all->current, file, first, error);
}

static hnbrdf_result read_files(importing *all, const char *const *texts, const size_t *sizes,
                                const char *const *names, int count,
                                const hnbrdf_import_options *options, hnbrdf_error *error)
{
    const char *const *files = options->files ? options->files : names;
    for (int i = 0; i < count; ++i) {
        hnbrdf_result result;
        if (!texts[i] || !names[i] || !files[i]) {
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s[%d] is NULL",
                               !texts[i]   ? "texts"
                               : !names[i] ? "names"
                                           : "files",
                               i);
        }
        published *p = i == 0 ? &all->first : &all->current;
        hnbrdf_brdf_parameters parameters = {
            .material = &all->materials[i], .name = names[i], .notes = &options->notes};
        if ((result = read_file(files[i], texts[i], sizes[i], p, &parameters, error)) ||
            (i > 0 && (result = compare(all, files[i], files[0], error))))
            return result;
    }
    return HNBRDF_OK;
}

static hnbrdf_result make_model(const importing *all, const char *const *names, int count,
                                const char *first, const hnbrdf_allocator *allocator,
                                hnbrdf_model **model, hnbrdf_error *error)
{
    const hnbrdf_brdf_network *n = &all->first.network;
    const hnbrdf_brdf_heading *heading = &all->first.heading;
    const int has_network = heading->kind != HNBRDF_KIND_GGX;
    hnbrdf_model_desc desc = {.kind = heading->kind,
                              .encoding = heading->encoding,
                              .hidden = has_network ? n->outputs[0] : 0,
                              .layers = has_network ? n->layers - 1 : 0,
                              .latent = all->first.latent,
                              .scale = all->first.scale,
                              .shift = all->first.shift,
                              .floor = heading->floor,
                              .material_count = count,
                              .materials = all->materials,
                              .names = names};
    if (desc.scale == 0) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: exp(S*(neural_output) + M) has S 0, expected another number",
                           first);
    }
    for (int k = 0; k < n->layers; ++k) {
        desc.weights[k] = n->weights[k];
        desc.biases[k] = n->biases[k];
    }
    return hnbrdf_model_create(&desc, allocator, model, error);
}

hnbrdf_result hnbrdf_model_import_brdf(const char *const *texts, const size_t *sizes,
                                       const char *const *names, int count,
                                       const hnbrdf_import_options *options, hnbrdf_model **model,
                                       hnbrdf_error *error)
{
    const hnbrdf_import_options settled = options ? *options : (hnbrdf_import_options){0};
    hnbrdf_allocator memory;
    hnbrdf_result result = hnbrdf_choose_allocator(&settled.allocator, &memory, error);
    if (result)
        return result;
    if (!texts || !sizes || !names || !model)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "texts, sizes, names or model is NULL");
    if (count < 1 || count > HNBRDF_MAX_MATERIALS) {
        return hnbrdf_fail(error, count < 1 ? HNBRDF_ERROR_ARGUMENT : HNBRDF_ERROR_LIMIT,
                           "%d .brdf files, expected 1 to %d", count, HNBRDF_MAX_MATERIALS);
    }
    const size_t size = sizeof(importing) + (size_t)count * sizeof(hnbrdf_material);
    importing *all = (importing *)hnbrdf_allocate(&memory, size);
    if (!all)
        return hnbrdf_fail_memory(error, size, "an import");
    result = read_files(all, texts, sizes, names, count, &settled, error);
    if (!result)
        result = make_model(all, names, count, settled.files ? settled.files[0] : names[0], &memory,
                            model, error);
    hnbrdf_release(&memory, all);
    return result;
}
