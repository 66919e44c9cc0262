/* brdf_parameters.c: the parameter lines of a published shader, and what of their values is moved
 * into the range of a material. */
#include "import/brdf_parameters.h"

#include "base/error.h"
#include "base/number.h"

#include <string.h>

enum {
    DIFFUSE_R,
    DIFFUSE_G,
    DIFFUSE_B,
    ETA_R,
    ETA_G,
    ETA_B,
    ALPHA_X,
    ALPHA_Y,
    ALPHA,
    ROTATION,
    LATENT
};
static const char *const PARAMETERS[LATENT] = {"diffuse_r", "diffuse_g", "diffuse_b", "eta_r",
                                               "eta_g",     "eta_b",     "alpha_x",   "alpha_y",
                                               "alpha",     "rotation"};

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
static int parameter_index(const hnbrdf_words *name, int has_rotation)
{
    for (int i = 0; i < (has_rotation ? LATENT : ROTATION); ++i)
        if (hnbrdf_words_at(name, PARAMETERS[i]))
            return i;
    const int latent = latent_index(name);
    return latent < 0 ? -1 : LATENT + latent;
}

/* ---- Ranges ---------------------------------------------------------------------------------- */

/* Published values are parameters as the trainer left them: clamped before a step of the optimiser
 * and not after it. One step of Adam is about its rate, 0.005 there, and seldom two. */
static const float ABOVE = 1.01f;
/* The next float above 1: a reflectance of 3.6e-15 instead of none. */
static const float LEAST_ETA = 1.00000012f;

/* The value within the range of a material, if it is out of it by no more than is allowed; *what
 * then says what it was taken as. */
static float within_range(int parameter, float value, const char **what)
{
    *what = NULL;
    if (parameter < ETA_R || (parameter >= ALPHA_X && parameter <= ALPHA)) {
        if (value > 1 && value <= ABOVE) {
            *what = "the largest there is";
            return 1;
        }
        if (parameter >= ALPHA_X && value >= 0 && value < HNBRDF_MIN_ALPHA) {
            *what = "the smallest that evaluation uses";
            return HNBRDF_MIN_ALPHA;
        }
    } else if (parameter < ALPHA_X && value == 1) {
        *what = "the smallest above 1";
        return LEAST_ETA;
    }
    return value;
}

static void set_parameter(hnbrdf_material *material, int parameter, float value)
{
    if (parameter >= LATENT) {
        material->latent[parameter - LATENT] = value;
    } else if (parameter == ROTATION) {
        material->rotation = value;
    } else if (parameter >= ALPHA_X) {
        material->alpha[0] = parameter == ALPHA_Y ? material->alpha[0] : value;
        material->alpha[1] = parameter == ALPHA_X ? material->alpha[1] : value;
    } else {
        (parameter >= ETA_R ? material->eta : material->kd)[parameter % 3] = value;
    }
}

/* With as many digits as tell them apart. */
static void print_both(char a_text[HNBRDF_NUMBER_TEXT], float a, char b_text[HNBRDF_NUMBER_TEXT],
                       float b)
{
    int digits = 7;
    do {
        hnbrdf_print_number(a_text, (double)a, digits);
        hnbrdf_print_number(b_text, (double)b, digits++);
    } while (a != b && strcmp(a_text, b_text) == 0);
}

/* ---- Lines ----------------------------------------------------------------------------------- */

hnbrdf_result hnbrdf_brdf_read_parameter(hnbrdf_words *words, hnbrdf_brdf_parameters *p,
                                         hnbrdf_error *error)
{
    hnbrdf_words ahead = *words;
    float low, high, value;
    const char *what;
    const int parameter =
        ahead.kind == HNBRDF_WORD_NAME ? parameter_index(&ahead, p->has_rotation) : -1;
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
    if (p->seen >> parameter & 1) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: line %d: found %.*s again, expected it once", words->file,
                           words->line, length, words->begin);
    }
    p->seen |= 1ul << parameter;
    const float taken = within_range(parameter, value, &what);
    if (what) {
        char found[HNBRDF_NUMBER_TEXT], used[HNBRDF_NUMBER_TEXT];
        print_both(found, value, used, taken);
        hnbrdf_note(p->notes, "%s: line %d: %.*s of %s is %s, taken as %s, %s", words->file,
                    words->line, length, words->begin, p->name, found, used, what);
    }
    set_parameter(p->material, parameter, taken);
    *words = ahead;
    return HNBRDF_OK;
}

/* alpha, or alpha_x and alpha_y; latent_0 to latent_N without a gap; all others. */
hnbrdf_result hnbrdf_brdf_check_parameters(const char *file, const hnbrdf_brdf_parameters *p,
                                           int *latent, hnbrdf_error *error)
{
    const unsigned long seen = p->seen;
    const unsigned long alphas = seen >> ALPHA_X & 7;
    int count = 0;
    const int analytic = p->kind != HNBRDF_KIND_NEURAL;
    for (int i = DIFFUSE_R; i < ALPHA_X; ++i) {
        if (analytic && !(seen >> i & 1)) {
            return hnbrdf_fail(
                error, HNBRDF_ERROR_FORMAT,
                "%s: has no parameter line for %s, expected \"float %s MIN MAX DEFAULT\"", file,
                PARAMETERS[i], PARAMETERS[i]);
        }
    }
    if (analytic && alphas != 3 && alphas != 4) {
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
