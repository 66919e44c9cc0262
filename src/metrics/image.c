/* image.c: MAE, MSE and PSNR between two linear images; the peak of PSNR is the reference's largest
 * value, as a rendering in radiance has no fixed white (DESIGN section 8). */
#include "hnbrdf/metrics.h"

#include <math.h>

void hnbrdf_image_compare(const float *image, const float *reference, size_t count,
                          hnbrdf_image_error *error)
{
    double absolute = 0.0, squared = 0.0, peak = 0.0;
    for (size_t k = 0; k < count; k++) {
        double difference = (double)image[k] - (double)reference[k];
        absolute += fabs(difference);
        squared += difference * difference;
        peak = fmax(peak, (double)reference[k]);
    }
    double n = count > 0 ? (double)count : 1.0;
    error->mae = absolute / n;
    error->mse = squared / n;
    /* An all-black reference has no peak: PSNR is then minus infinity, or infinite if equal. */
    if (squared == 0.0)
        error->psnr = (double)INFINITY;
    else
        error->psnr = 10.0 * log10(peak * peak / error->mse);
}
