/* physics.c: energy, reciprocity and positivity of a material, by evaluating it over all angles. */
#include "metrics/albedo.h"

#include <math.h>
#include <string.h>

/* ---- Directional albedo ---------------------------------------------------------------------- */

static const double PI = 3.14159265358979323846;

/* Degrees from n: every four, then nearer to the horizon. */
enum { EVEN_ANGLES = 23, ANGLES = 26 };
static const double last_angles[ANGLES - EVEN_ANGLES] = {89.0, 89.5, 89.9};

static void find_albedo(const hnbrdf_model *model, const hnbrdf_material *material,
                        hnbrdf_physics *physics)
{
    int azimuths = material->alpha[0] == material->alpha[1] ? 1 : HNBRDF_ALBEDO_AZIMUTHS;
    for (int t = 0; t < ANGLES; t++)
        for (int a = 0; a < azimuths; a++) {
            const double degrees = t < EVEN_ANGLES ? 4.0 * t : last_angles[t - EVEN_ANGLES];
            const double theta = degrees * PI / 180.0;
            double albedo[3];
            double phi = (double)material->rotation + PI * a / azimuths;
            const float wo[3] = {(float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)),
                                 (float)cos(theta)};
            hnbrdf_albedo(model, material, wo, albedo);
            for (int c = 0; c < 3; c++)
                if (albedo[c] > physics->albedo) {
                    physics->albedo = albedo[c];
                    physics->albedo_theta = theta;
                    physics->albedo_channel = c;
                }
        }
}

/* ---- Reciprocity, positivity ----------------------------------------------------------------- */

static void compare_swapped(const hnbrdf_model *model, const hnbrdf_material *material,
                            hnbrdf_physics *physics)
{
    enum { PAIRS = 4096 };
    hnbrdf_rng rng;
    double sum = 0.0, worst = 0.0;
    size_t black = 0;
    physics->valid = 1;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; k < PAIRS; k++) {
        float wi[3], wo[3], f[2][3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        hnbrdf_eval(model, material, wi, wo, f[0]);
        hnbrdf_eval(model, material, wo, wi, f[1]);
        for (int c = 0; c < 3; c++) {
            double error = hnbrdf_smape((double)f[0][c], (double)f[1][c]);
            sum += error;
            worst = fmax(worst, error);
            black += f[0][c] == 0.0f;
            physics->valid &= isfinite(f[0][c]) && f[0][c] >= 0.0f;
        }
    }
    physics->reciprocity = sum / (3 * PAIRS);
    physics->reciprocity_worst = worst;
    physics->black = (double)black / (3 * PAIRS);
}

void hnbrdf_physics_of(const hnbrdf_model *model, const hnbrdf_material *material,
                       hnbrdf_physics *physics)
{
    memset(physics, 0, sizeof *physics);
    find_albedo(model, material, physics);
    compare_swapped(model, material, physics);
}
