/* import_brdf.c: make a model of the published BRDF-Explorer .brdf files of one dataset.
 * Each holds one material as parameter lines and, written out in GLSL, the network of all. */
#include "base/error.h"
#include "import/brdf_network.h"
#include "import/brdf_text.h"
#include "base/memory.h"
#include "base/text.h"

#include <string.h>

/* What one file holds. */
typedef struct published {
    hnbrdf_brdf_network network;
    float scale, shift; /* exp(scale c + shift) */
    int has_exponent;
    int latent;
} published;

/* ---- Parameters ------------------------------------------------------------------------------ */

enum { DIFFUSE_R, DIFFUSE_G, DIFFUSE_B, ETA_R, ETA_G, ETA_B, ALPHA_X, ALPHA_Y, ALPHA, LATENT };
static const char *const PARAMETERS[LATENT] = {"diffuse_r", "diffuse_g", "diffuse_b",
                                               "eta_r",     "eta_g",     "eta_b",
                                               "alpha_x",   "alpha_y",   "alpha"};

/* The index of latent_N behind the underscore, or -1. */
static int latent_index(const hnbrdf_words *name)
{
    static const char PREFIX[] = "latent_";
    const size_t length = (size_t)(name->stop - name->begin), prefix = sizeof PREFIX - 1;
    int index = 0;
    if (length <= prefix || length > prefix + 4 || memcmp(name->begin, PREFIX, prefix) != 0)
        return -1;
    for (const char *at = name->begin + prefix; at < name->stop; ++at) {
        if (*at < '0' || *at > '9')
            return -1;
        index = index * 10 + (*at - '0');
    }
    return index;
}

/* PARAMETERS index, LATENT + N, or -1 for a parameter of no interest here. */
static int parameter_index(const hnbrdf_words *name)
{
    for (int i = 0; i < LATENT; ++i)
        if (hnbrdf_words_at(name, PARAMETERS[i]))
            return i;
    const int latent = latent_index(name);
    return latent < 0 ? -1 : LATENT + latent;
}

static void set_parameter(hnbrdf_material *material, int parameter, float value)
{
    if (parameter >= LATENT) {
        material->latent[parameter - LATENT] = value;
    } else if (parameter >= ALPHA_X) {
        /* Rougher than the smallest roughness that can be evaluated; nonsense is left to the
         * check. */
        const float alpha = value >= 0 && value < HNBRDF_MIN_ALPHA ? HNBRDF_MIN_ALPHA : value;
        material->alpha[0] = parameter == ALPHA_Y ? material->alpha[0] : alpha;
        material->alpha[1] = parameter == ALPHA_X ? material->alpha[1] : alpha;
    } else {
        (parameter >= ETA_R ? material->eta : material->kd)[parameter % 3] = value;
    }
}

/* float NAME MIN MAX DEFAULT, from behind float; anything else is left where it is. */
static hnbrdf_result read_parameter(hnbrdf_words *words, hnbrdf_material *material,
                                    unsigned long *seen, hnbrdf_error *error)
{
    hnbrdf_words ahead = *words;
    float low, high, value;
    const int parameter = ahead.kind == HNBRDF_WORD_NAME ? parameter_index(&ahead) : -1;
    if (parameter < 0)
        return HNBRDF_OK;
    hnbrdf_words_next(&ahead);
    if (!hnbrdf_words_take_number(&ahead, &low) || !hnbrdf_words_take_number(&ahead, &high) ||
        !hnbrdf_words_take_number(&ahead, &value))
        return HNBRDF_OK;
    const int length = (int)(words->stop - words->begin);
    if (parameter >= LATENT + HNBRDF_MAX_LATENT) {
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT,
                           "%s: line %d: found %.*s, expected at most latent_%d", words->file,
                           words->line, length, words->begin, HNBRDF_MAX_LATENT - 1);
    }
    if (*seen >> parameter & 1) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: line %d: found %.*s again, expected it once", words->file,
                           words->line, length, words->begin);
    }
    *seen |= 1ul << parameter;
    set_parameter(material, parameter, value);
    *words = ahead;
    return HNBRDF_OK;
}

/* alpha, or alpha_x and alpha_y; latent_0 to latent_N without a gap; all others. */
static hnbrdf_result check_parameters(const char *file, unsigned long seen, int *latent,
                                      hnbrdf_error *error)
{
    const unsigned long alphas = seen >> ALPHA_X & 7;
    int count = 0;
    for (int i = DIFFUSE_R; i < ALPHA_X; ++i) {
        if (!(seen >> i & 1)) {
            return hnbrdf_fail(
                error, HNBRDF_ERROR_FORMAT,
                "%s: has no parameter line for %s, expected \"float %s MIN MAX DEFAULT\"", file,
                PARAMETERS[i], PARAMETERS[i]);
        }
    }
    if (alphas != 3 && alphas != 4) {
        return hnbrdf_fail(
            error, HNBRDF_ERROR_FORMAT,
            "%s: has parameter lines for%s%s%s%s, expected alpha, or alpha_x and alpha_y", file,
            alphas & 1 ? " alpha_x" : "", alphas & 2 ? " alpha_y" : "", alphas & 4 ? " alpha" : "",
            alphas ? "" : " no alpha");
    }
    while (seen >> (LATENT + count) & 1)
        ++count;
    if (seen >> (LATENT + count) != 0) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: has no parameter line for latent_%d, but a later one, expected all",
                           file, count);
    }
    *latent = count;
    return HNBRDF_OK;
}

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
    const int last = n->layers - 1;
    if (last < 0) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: has no function mlp_eval, expected one",
                           file);
    }
    if (!p->has_exponent) {
        return hnbrdf_fail(
            error, HNBRDF_ERROR_FORMAT,
            "%s: has no line neural_output = exp(S*(neural_output) + M), expected one", file);
    }
    if (last < 1 || n->outputs[last] != 6) {
        return hnbrdf_fail(
            error, HNBRDF_ERROR_UNSUPPORTED,
            "%s: mlp_eval has %d layers and %d outputs, expected at least 2 layers and 6 "
            "outputs, correction and gate",
            file, n->layers, n->outputs[last]);
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

static hnbrdf_result read_file(const char *file, const char *text, size_t size, published *p,
                               hnbrdf_material *material, hnbrdf_error *error)
{
    hnbrdf_words words;
    hnbrdf_error inner;
    unsigned long seen = 0;
    hnbrdf_result result = HNBRDF_OK;
    memset(p, 0, sizeof *p);
    hnbrdf_material_init(material);
    hnbrdf_words_begin(&words, file, text, size);
    while (!result && words.kind != HNBRDF_WORD_END) {
        if (hnbrdf_words_take(&words, "float")) {
            result = read_parameter(&words, material, &seen, error);
        } else if (hnbrdf_words_take(&words, "mlp_eval")) {
            if (take_definition(&words)) {
                hnbrdf_words body = words; /* the line with exp may stand in it */
                result = p->network.layers
                             ? hnbrdf_words_fail(&words, "one function mlp_eval", error)
                             : hnbrdf_brdf_read_network(&body, &p->network, error);
            }
        } else if (hnbrdf_words_take(&words, "neural_output")) {
            if (take_exponent(&words))
                result = read_exponent(&words, p, error);
        } else {
            hnbrdf_words_next(&words);
        }
    }
    if (result || (result = check_parameters(file, seen, &p->latent, error)) ||
        (result = check_network(file, p, error)))
        return result;
    if ((result = hnbrdf_material_check(material, &inner)))
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

/* All files of a dataset carry one network. */
static hnbrdf_result compare(const importing *all, const char *file, const char *first,
                             hnbrdf_error *error)
{
    const hnbrdf_brdf_network *a = &all->first.network, *b = &all->current.network;
    hnbrdf_result result = HNBRDF_OK;
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
                                const char *const *names, int count, hnbrdf_error *error)
{
    for (int i = 0; i < count; ++i) {
        hnbrdf_result result;
        if (!texts[i] || !names[i]) {
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s[%d] is NULL",
                               texts[i] ? "names" : "texts", i);
        }
        published *p = i == 0 ? &all->first : &all->current;
        if ((result = read_file(names[i], texts[i], sizes[i], p, &all->materials[i], error)) ||
            (i > 0 && (result = compare(all, names[i], names[0], error))))
            return result;
    }
    return HNBRDF_OK;
}

static hnbrdf_result make_model(const importing *all, const char *const *names, int count,
                                const hnbrdf_allocator *allocator, hnbrdf_model **model,
                                hnbrdf_error *error)
{
    const hnbrdf_brdf_network *n = &all->first.network;
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_HYBRID,
                              .encoding = HNBRDF_ENCODING_DIRECTIONS,
                              .hidden = n->outputs[0],
                              .layers = n->layers - 1,
                              .latent = all->first.latent,
                              .scale = all->first.scale,
                              .shift = all->first.shift,
                              .material_count = count,
                              .materials = all->materials,
                              .names = names};
    if (desc.scale == 0) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: exp(S*(neural_output) + M) has S 0, expected another number",
                           names[0]);
    }
    for (int k = 0; k < n->layers; ++k) {
        desc.weights[k] = n->weights[k];
        desc.biases[k] = n->biases[k];
    }
    return hnbrdf_model_create(&desc, allocator, model, error);
}

hnbrdf_result hnbrdf_model_import_brdf(const char *const *texts, const size_t *sizes,
                                       const char *const *names, int count,
                                       const hnbrdf_allocator *allocator, hnbrdf_model **model,
                                       hnbrdf_error *error)
{
    hnbrdf_allocator memory;
    hnbrdf_result result = hnbrdf_choose_allocator(allocator, &memory, error);
    if (result)
        return result;
    if (!texts || !sizes || !names || !model)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "texts, sizes, names or model is NULL");
    if (count < 1 || count > HNBRDF_MAX_MATERIALS) {
        return hnbrdf_fail(error, count < 1 ? HNBRDF_ERROR_ARGUMENT : HNBRDF_ERROR_LIMIT,
                           "%d .brdf files, expected 1 to %d", count, HNBRDF_MAX_MATERIALS);
    }
    const size_t size = sizeof(importing) + (size_t)count * sizeof(hnbrdf_material);
    importing *all = hnbrdf_allocate(&memory, size);
    if (!all)
        return hnbrdf_fail_memory(error, size, "an import");
    result = read_files(all, texts, sizes, names, count, error);
    if (!result)
        result = make_model(all, names, count, &memory, model, error);
    hnbrdf_release(&memory, all);
    return result;
}
