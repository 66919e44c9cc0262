/* bright.c: pairs where a picture of a material is bright, chosen among candidates. */
#include "fit/bright.h"

#include "fit/kernel.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* Share of the grid sampler's draws that are above the horizon by 0.01, of 1e8 (+- 5e-5); it draws
 * the others anew. */
#define GRID_ABOVE 0.743946
/* Half vectors nearer to the normal than this, and differences narrower, count as that near: the
 * density has a pole there. Both angles are found with an error of about 1e-7. */
#define LEAST_SINE 1e-6

double hnbrdf_fit_grid_density(const float wi[3], const float wo[3])
{
    double sum[3], sum2 = 0.0, difference2 = 0.0;
    for (int k = 0; k < 3; k++) {
        const double difference = (double)wi[k] - (double)wo[k];
        sum[k] = (double)wi[k] + (double)wo[k];
        sum2 += sum[k] * sum[k];
        difference2 += difference * difference;
    }
    const double across = sqrt(sum[0] * sum[0] + sum[1] * sum[1]);
    const double sine_h = fmax(across / sqrt(sum2), LEAST_SINE);
    const double theta_h = fmax(atan2(across, sum[2]), LEAST_SINE);
    const double cosine_d = 0.5 * sqrt(sum2), sine_d = fmax(0.5 * sqrt(difference2), LEAST_SINE);
    /* theta_h = u^2 pi/2 has density 1/sqrt(2 pi theta_h), theta_d 2/pi; azimuths 1/(2 pi) each;
     * d wi d wo = 4 cos theta_d d h d d */
    const double of_h = 1.0 / (sqrt(2.0 * PI * theta_h) * 2.0 * PI * sine_h);
    const double of_d = (2.0 / PI) / (2.0 * PI * sine_d);
    return of_h * of_d / (4.0 * cosine_d) / GRID_ABOVE;
}

/* How much brighter a candidate is than its density says. A little is added to f, so that black
 * materials have pairs too. */
static double weigh(const float wi[3], const float wo[3], const float f[3])
{
    const double cosines = (double)wi[2] * (double)wo[2];
    double value = 1e-6;
    for (int c = 0; c < 3; c++)
        value += fmin(fmax((double)f[c], 0.0), (double)FIT_MOST);
    return value * cosines / (hnbrdf_fit_grid_density(wi, wo) + cosines / (PI * PI));
}

int hnbrdf_fit_bright_draw(const hnbrdf_measured *measured, hnbrdf_rng *rng, float wi[3],
                           float wo[3], float f[3])
{
    double sum = 0.0;
    int valid = 0;
    for (int k = 0; k < FIT_BRIGHT_CANDIDATES; k++) {
        float i[3], o[3], value[3];
        hnbrdf_sampler_draw(k % 2 ? HNBRDF_SAMPLER_COSINE : HNBRDF_SAMPLER_GRID, rng, i, o);
        const double choice = (double)hnbrdf_rng_float(rng);
        if (!hnbrdf_measured_eval(measured, i, o, value))
            continue;
        const double weight = weigh(i, o, value);
        sum += weight;
        valid++;
        if (choice * sum < weight) { /* each stays with its share of the sum */
            memcpy(wi, i, sizeof i);
            memcpy(wo, o, sizeof o);
            memcpy(f, value, sizeof value);
        }
    }
    return valid;
}
