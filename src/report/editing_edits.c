/* editing_edits.c: the edits that are tried, what each means for the truth of a family, and how it
 * is made on a material of a model. */
#include "report/editing.h"

#include "base/error.h"
#include "base/text.h"
#include "hnbrdf/edit.h"

#include <math.h>
#include <string.h>

const editing_edit editing_edits[] = {
    {EDITING_ALPHA, 0.25},   {EDITING_ALPHA, 0.5},      {EDITING_ALPHA, 2.0 / 3.0},
    {EDITING_ALPHA, 1.0},    {EDITING_ALPHA, 1.5},      {EDITING_ALPHA, 2.0},
    {EDITING_ALPHA, 3.0},    {EDITING_ALPHA, 4.0},      {EDITING_ETA, 0.5},
    {EDITING_ETA, 2.0},      {EDITING_KD, 0.5},         {EDITING_KD, 1.5},
    {EDITING_COLOUR, 1.0},   {EDITING_ANISOTROPY, 2.0}, {EDITING_ANISOTROPY, 4.0},
    {EDITING_ROTATION, 0.5},
};
const int editing_edit_count = sizeof editing_edits / sizeof editing_edits[0];

/* EDITING_COLOUR: towards blue. */
static const double colour_ratio[3] = {0.4, 0.7, 1.0};

const char *editing_kind_name(editing_kind kind)
{
    static const char *const names[EDITING_KINDS] = {"alpha",  "eta",        "kd",
                                                     "colour", "anisotropy", "rotation"};
    return names[kind];
}

void editing_edit_name(const editing_edit *edit, char *text, size_t size)
{
    const char *name = editing_kind_name(edit->kind);
    char number[HNBRDF_NUMBER_TEXT];
    hnbrdf_print_number(number, edit->factor, 3);
    if (edit->kind == EDITING_COLOUR)
        snprintf(text, size, "%s", name);
    else
        snprintf(text, size, edit->kind == EDITING_ROTATION ? "%s + %s" : "%s x %s", name, number);
}

int editing_makes_sense(const editing_edit *edit, int family)
{
    static const int needed[EDITING_KINDS] = {
        [EDITING_ETA] = HNBRDF_FAMILY_ETA,
        [EDITING_KD] = HNBRDF_FAMILY_DIFFUSE,
        [EDITING_ANISOTROPY] = HNBRDF_FAMILY_STRETCH,
        [EDITING_ROTATION] = HNBRDF_FAMILY_BRUSHED,
    };
    return (hnbrdf_family_has(family) & needed[edit->kind]) == needed[edit->kind];
}

/* The factors of alpha_x and alpha_y. */
static void alpha_factors(const editing_edit *edit, double factors[2])
{
    factors[0] = factors[1] = 1.0;
    if (edit->kind == EDITING_ALPHA)
        factors[0] = factors[1] = edit->factor;
    if (edit->kind == EDITING_ANISOTROPY) {
        factors[0] = edit->factor;
        factors[1] = 1.0 / edit->factor;
    }
}

/* The factors of the reflectance and of the diffuse part, per channel. */
static void colour_factors(const editing_edit *edit, int family, double reflectance[3],
                           double diffuse[3])
{
    int has_diffuse = hnbrdf_family_has(family) & HNBRDF_FAMILY_DIFFUSE;
    for (int c = 0; c < 3; c++) {
        reflectance[c] = edit->kind == EDITING_ETA                      ? edit->factor
                         : edit->kind == EDITING_COLOUR && !has_diffuse ? colour_ratio[c]
                                                                        : 1.0;
        diffuse[c] = edit->kind == EDITING_KD                      ? edit->factor
                     : edit->kind == EDITING_COLOUR && has_diffuse ? colour_ratio[c]
                                                                   : 1.0;
    }
}

int editing_edit_truth(const editing_edit *edit, int family, hnbrdf_family_parameters *parameters)
{
    double alpha[2], reflectance[3], diffuse[3];
    int inside = 1;
    alpha_factors(edit, alpha);
    colour_factors(edit, family, reflectance, diffuse);
    for (int k = 0; k < 2; k++) {
        parameters->alpha[k] *= alpha[k];
        inside &= parameters->alpha[k] >= (double)HNBRDF_MIN_ALPHA && parameters->alpha[k] <= 1.0;
    }
    for (int c = 0; c < 3; c++) {
        parameters->reflectance[c] *= reflectance[c];
        parameters->diffuse[c] *= diffuse[c];
    }
    if (edit->kind == EDITING_ROTATION)
        parameters->rotation += edit->factor;
    return inside;
}

/* ---- A material of a model ------------------------------------------------------------------- */

/* FIELD=VALUE:VALUE:VALUE, each between low and high. */
static hnbrdf_result set_field(hnbrdf_material *material, const char *field, const double *values,
                               int count, double low, double high, int *stopped,
                               hnbrdf_error *error)
{
    char text[160];
    size_t at = (size_t)snprintf(text, sizeof text, "%s", field);
    for (int k = 0; k < count; k++) {
        double value = fmin(fmax(values[k], low), high);
        *stopped |= value != values[k];
        text[at++] = k ? ':' : '=';
        at += (size_t)hnbrdf_format_float(text + at, sizeof text - at, (float)value);
    }
    return hnbrdf_material_set(material, text, error);
}

/* The index whose reflectance at normal incidence is `factor` times that of eta. */
static double scaled_index(double eta, double factor)
{
    double r = (eta - 1.0) / (eta + 1.0) * sqrt(factor);
    return r < 1.0 ? (1.0 + r) / (1.0 - r) : INFINITY;
}

hnbrdf_result editing_edit_material(const editing_edit *edit, int family, hnbrdf_material *material,
                                    int *stopped, hnbrdf_error *error)
{
    double factors[2], reflectance[3], diffuse[3], alpha[2], eta[3], kd[3];
    double turned = (double)material->rotation + edit->factor;
    hnbrdf_result result = HNBRDF_OK;
    *stopped = 0;
    alpha_factors(edit, factors);
    colour_factors(edit, family, reflectance, diffuse);
    for (int k = 0; k < 2; k++)
        alpha[k] = (double)material->alpha[k] * factors[k];
    for (int c = 0; c < 3; c++) {
        eta[c] = scaled_index((double)material->eta[c], reflectance[c]);
        kd[c] = (double)material->kd[c] * diffuse[c];
    }
    switch (edit->kind) {
    case EDITING_ALPHA:
    case EDITING_ANISOTROPY:
        if (edit->factor != 1.0)
            result = set_field(material, "alpha", alpha, 2, (double)HNBRDF_MIN_ALPHA, 1.0, stopped,
                               error);
        break;
    case EDITING_ETA:
        result =
            set_field(material, "eta", eta, 3, 1.0 + 1e-6, (double)HNBRDF_MAX_ETA, stopped, error);
        break;
    case EDITING_KD:
        result = set_field(material, "kd", kd, 3, 0.0, 1.0, stopped, error);
        break;
    case EDITING_COLOUR:
        result = hnbrdf_family_has(family) & HNBRDF_FAMILY_DIFFUSE
                     ? set_field(material, "kd", kd, 3, 0.0, 1.0, stopped, error)
                     : set_field(material, "eta", eta, 3, 1.0 + 1e-6, (double)HNBRDF_MAX_ETA,
                                 stopped, error);
        break;
    case EDITING_ROTATION:
        result = set_field(material, "rotation", &turned, 1, -1e3, 1e3, stopped, error);
        break;
    case EDITING_KINDS:
        break;
    }
    return result ? result : hnbrdf_material_check(material, error);
}
