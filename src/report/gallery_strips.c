/* gallery_strips.c: what the gallery does to a material: roughness, colour, refraction, anisotropy,
 * mixing. */
#include "report/gallery.h"

#include "hnbrdf/edit.h"

#include <math.h>
#include <stdio.h>

static hnbrdf_material *begin(report_strip *strip, const hnbrdf_material *material)
{
    for (int k = 0; k < REPORT_GALLERY_EDITS; k++)
        strip->materials[k] = *material;
    snprintf(strip->captions[0], sizeof strip->captions[0], "as fitted");
    return strip->materials;
}

void report_strip_alpha(const hnbrdf_material *material, report_strip *strip)
{
    static const double alphas[REPORT_GALLERY_EDITS] = {0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8};
    hnbrdf_material *edited = begin(strip, material);
    /* A geometric mean of the given value; what anisotropy there is stays. */
    double mean = sqrt((double)material->alpha[0] * (double)material->alpha[1]);
    for (int k = 1; k < REPORT_GALLERY_EDITS; k++) {
        for (int a = 0; a < 2; a++) {
            float alpha = (float)(alphas[k] * (double)material->alpha[a] / mean);
            edited[k].alpha[a] = fminf(fmaxf(alpha, HNBRDF_MIN_ALPHA), HNBRDF_MAX_ALPHA);
        }
        snprintf(strip->captions[k], sizeof strip->captions[k], "alpha %g", alphas[k]);
    }
    snprintf(strip->captions[0], sizeof strip->captions[0], "as fitted, %.2g", mean);
    snprintf(strip->command, sizeof strip->command, "--set alpha=%g",
             alphas[REPORT_GALLERY_EDITS - 1]);
}

void report_strip_kd(const hnbrdf_material *material, report_strip *strip)
{
    static const float colours[REPORT_GALLERY_EDITS][3] = {{0, 0, 0},
                                                           {0.62f, 0.05f, 0.04f},
                                                           {0.75f, 0.33f, 0.03f},
                                                           {0.12f, 0.42f, 0.06f},
                                                           {0.02f, 0.36f, 0.4f},
                                                           {0.04f, 0.1f, 0.55f},
                                                           {0.33f, 0.05f, 0.42f}};
    hnbrdf_material *edited = begin(strip, material);
    for (int k = 1; k < REPORT_GALLERY_EDITS; k++) {
        for (int c = 0; c < 3; c++)
            edited[k].kd[c] = colours[k][c];
        snprintf(strip->captions[k], sizeof strip->captions[k], "kd %g %g %g",
                 (double)colours[k][0], (double)colours[k][1], (double)colours[k][2]);
    }
    const float *last = colours[REPORT_GALLERY_EDITS - 1];
    snprintf(strip->command, sizeof strip->command, "--set kd=%g:%g:%g", (double)last[0],
             (double)last[1], (double)last[2]);
}

/* The last one reflects as gold does at normal incidence. */
void report_strip_eta(const hnbrdf_material *material, report_strip *strip)
{
    static const float etas[REPORT_GALLERY_EDITS][3] = {
        {0, 0, 0},          {1.2f, 1.2f, 1.2f}, {1.5f, 1.5f, 1.5f}, {2, 2, 2},
        {3.5f, 3.5f, 3.5f}, {10, 10, 10},       {40, 15, 4}};
    hnbrdf_material *edited = begin(strip, material);
    for (int k = 1; k < REPORT_GALLERY_EDITS; k++) {
        for (int c = 0; c < 3; c++)
            edited[k].eta[c] = etas[k][c];
        if (etas[k][0] == etas[k][2])
            snprintf(strip->captions[k], sizeof strip->captions[k], "eta %g", (double)etas[k][0]);
        else
            snprintf(strip->captions[k], sizeof strip->captions[k], "eta %g %g %g",
                     (double)etas[k][0], (double)etas[k][1], (double)etas[k][2]);
    }
    const float *last = etas[REPORT_GALLERY_EDITS - 1];
    snprintf(strip->command, sizeof strip->command, "--set eta=%g:%g:%g", (double)last[0],
             (double)last[1], (double)last[2]);
}

void report_strip_anisotropy(const hnbrdf_material *material, report_strip *strip)
{
    static const struct {
        double ratio, degrees;
    } edits[REPORT_GALLERY_EDITS] = {{1, 0}, {2, 0}, {4, 0}, {8, 0}, {8, 30}, {8, 60}, {8, 90}};
    hnbrdf_material *edited = begin(strip, material);
    /* The same mean roughness, but no wider than allowed along x. */
    double mean = sqrt((double)material->alpha[0] * (double)material->alpha[1]);
    for (int k = 1; k < REPORT_GALLERY_EDITS; k++) {
        double x = fmin(mean * sqrt(edits[k].ratio), (double)HNBRDF_MAX_ALPHA);
        double y = fmax(x / edits[k].ratio, (double)HNBRDF_MIN_ALPHA);
        edited[k].alpha[0] = (float)x;
        edited[k].alpha[1] = (float)y;
        edited[k].rotation = (float)(edits[k].degrees * 3.14159265358979323846 / 180.0);
        if (edits[k].degrees > 0.0)
            snprintf(strip->captions[k], sizeof strip->captions[k], "%g : 1, %g deg",
                     edits[k].ratio, edits[k].degrees);
        else
            snprintf(strip->captions[k], sizeof strip->captions[k], "%g : 1", edits[k].ratio);
        if (k == REPORT_GALLERY_EDITS - 1)
            snprintf(strip->command, sizeof strip->command, "--set alpha=%.3g:%.3g,rotation=%gdeg",
                     x, y, edits[k].degrees);
    }
}

hnbrdf_result report_strip_mix(const hnbrdf_model *model, const hnbrdf_material *a,
                               const hnbrdf_material *b, report_strip *strip, hnbrdf_error *error)
{
    hnbrdf_material path[HNBRDF_MIX_KNOTS];
    hnbrdf_result result = hnbrdf_mix_path_fit(model, a, b, path, error);
    if (result)
        return result;
    begin(strip, a);
    for (int k = 0; k < REPORT_GALLERY_EDITS; k++) {
        float t = (float)k / (REPORT_GALLERY_EDITS - 1);
        hnbrdf_mix_path_at(path, t, &strip->materials[k]);
        snprintf(strip->captions[k], sizeof strip->captions[k], "t = %.2f", (double)t);
    }
    snprintf(strip->command, sizeof strip->command, "--t 0:1:%.4g",
             1.0 / (REPORT_GALLERY_EDITS - 1));
    return HNBRDF_OK;
}
