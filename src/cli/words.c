/* words.c: the names of the library's enums, as options take them. */
#include "cli/words.h"

#include "hnbrdf/fit.h"
#include "hnbrdf/hnbrdf.h"
#include "hnbrdf/metrics.h"
#include "hnbrdf/glsl.h"

#include <stddef.h>

const char *cli_kind_word(int value)
{
    return hnbrdf_kind_name((hnbrdf_kind)value);
}

const char *cli_sampler_word(int value)
{
    return hnbrdf_sampler_name((hnbrdf_sampler)value);
}

const char *cli_encoding_word(int value)
{
    return hnbrdf_encoding_name((hnbrdf_encoding)value);
}

const char *cli_variant_word(int value)
{
    return hnbrdf_variant_name((hnbrdf_variant)value);
}

const char *cli_weights_word(int value)
{
    return hnbrdf_glsl_weights_name((hnbrdf_glsl_weights)value);
}

const char *cli_precision_word(int value)
{
    return hnbrdf_glsl_precision_name((hnbrdf_glsl_precision)value);
}

const char *cli_language_word(int value)
{
    return hnbrdf_shading_language_name((hnbrdf_shading_language)value);
}

/* Those that only commands name. */
const char *cli_analytic_word(int value)
{
    static const char *const words[] = {
        [HNBRDF_FIT_FAITHFUL] = "faithful", [HNBRDF_FIT_JOINT] = "joint"};
    return value >= 0 && value < (int)(sizeof words / sizeof words[0]) ? words[value] : NULL;
}

const char *cli_loss_word(int value)
{
    static const char *const words[] = {[HNBRDF_FIT_LOG_TO_SMAPE] = "log-to-smape",
                                        [HNBRDF_FIT_LOG] = "log",
                                        [HNBRDF_FIT_SMAPE] = "smape"};
    return value >= 0 && value < (int)(sizeof words / sizeof words[0]) ? words[value] : NULL;
}

const char *cli_schedule_word(int value)
{
    static const char *const words[] = {[HNBRDF_FIT_COSINE] = "cosine",
                                        [HNBRDF_FIT_LINEAR] = "linear",
                                        [HNBRDF_FIT_CONSTANT] = "constant"};
    return value >= 0 && value < (int)(sizeof words / sizeof words[0]) ? words[value] : NULL;
}
