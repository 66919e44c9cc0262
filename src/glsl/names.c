/* names.c: the words for what an export can be asked for, and the way back from a word. */
#include "hnbrdf/glsl.h"

#include <string.h>

static const char *const weights_names[] = {
    [HNBRDF_GLSL_CONSTANTS] = "constants",
    [HNBRDF_GLSL_COLUMNS] = "columns",
    [HNBRDF_GLSL_UNIFORM] = "uniform",
};
static const char *const precision_names[] = {
    [HNBRDF_GLSL_FLOAT] = "float",
    [HNBRDF_GLSL_HALF] = "half",
};
static const char *const language_names[] = {
    [HNBRDF_LANGUAGE_GLSL] = "glsl",   [HNBRDF_LANGUAGE_HLSL] = "hlsl",
    [HNBRDF_LANGUAGE_MSL] = "msl",     [HNBRDF_LANGUAGE_WGSL] = "wgsl",
    [HNBRDF_LANGUAGE_SLANG] = "slang", [HNBRDF_LANGUAGE_BRDF] = "brdf",
};

enum {
    WEIGHTS = sizeof weights_names / sizeof weights_names[0],
    PRECISIONS = sizeof precision_names / sizeof precision_names[0],
    LANGUAGES = sizeof language_names / sizeof language_names[0]
};

static int find(const char *const *names, int count, const char *name)
{
    for (int k = 0; k < count; k++)
        if (strcmp(name, names[k]) == 0)
            return k;
    return -1;
}

const char *hnbrdf_glsl_weights_name(hnbrdf_glsl_weights weights)
{
    return (unsigned)weights < WEIGHTS ? weights_names[weights] : NULL;
}

const char *hnbrdf_glsl_precision_name(hnbrdf_glsl_precision precision)
{
    return (unsigned)precision < PRECISIONS ? precision_names[precision] : NULL;
}

int hnbrdf_glsl_weights_from_name(const char *name, hnbrdf_glsl_weights *weights)
{
    int k = find(weights_names, WEIGHTS, name);
    if (k >= 0)
        *weights = (hnbrdf_glsl_weights)k;
    return k >= 0;
}

int hnbrdf_glsl_precision_from_name(const char *name, hnbrdf_glsl_precision *precision)
{
    int k = find(precision_names, PRECISIONS, name);
    if (k >= 0)
        *precision = (hnbrdf_glsl_precision)k;
    return k >= 0;
}

const char *hnbrdf_shading_language_name(hnbrdf_shading_language language)
{
    return (unsigned)language < LANGUAGES ? language_names[language] : NULL;
}

int hnbrdf_shading_language_from_name(const char *name, hnbrdf_shading_language *language)
{
    int k = find(language_names, LANGUAGES, name);
    if (k >= 0)
        *language = (hnbrdf_shading_language)k;
    return k >= 0;
}

hnbrdf_glsl_weights hnbrdf_shading_language_weights(hnbrdf_shading_language language)
{
    return language == HNBRDF_LANGUAGE_GLSL || language == HNBRDF_LANGUAGE_BRDF
               ? HNBRDF_GLSL_CONSTANTS
               : HNBRDF_GLSL_COLUMNS;
}
