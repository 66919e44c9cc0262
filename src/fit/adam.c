/* adam.c: one step of Adam. */
#include "fit/adam.h"

#include <math.h>

void hnbrdf_fit_adam(float *parameters, const float *gradient, float *m, float *v, size_t count,
                     long step, double rate)
{
    const float b1 = (float)FIT_ADAM_BETA1, b2 = (float)FIT_ADAM_BETA2;
    const float correct1 = (float)(rate / (1.0 - pow(FIT_ADAM_BETA1, (double)step)));
    const float correct2 = (float)(1.0 / (1.0 - pow(FIT_ADAM_BETA2, (double)step)));
    for (size_t i = 0; i < count; i++) {
        float g = gradient[i];
        if (!(fabsf(g) <= 1e18f))
            continue;
        m[i] = b1 * m[i] + (1.0f - b1) * g;
        v[i] = b2 * v[i] + (1.0f - b2) * (g * g);
        parameters[i] -= correct1 * m[i] / (sqrtf(v[i] * correct2) + 1e-8f);
    }
}
