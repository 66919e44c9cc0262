/* image.c: MAE, MSE and PSNR between two linear images, and what noise does to them; the peak of
 * PSNR is the reference's largest value, as a rendering in radiance has no fixed
 * white. */
#include "hnbrdf/metrics.h"

#include <math.h>

/* Sums over the values of an image. */
typedef struct image_sums {
    double absolute, squared, peak;
    size_t count;
} image_sums;

static void add_value(image_sums *sums, double value, double reference)
{
    double difference = value - reference;
    sums->absolute += fabs(difference);
    sums->squared += difference * difference;
    sums->peak = fmax(sums->peak, reference);
    sums->count++;
}

static void finish(const image_sums *sums, hnbrdf_image_error *error)
{
    double n = sums->count > 0 ? (double)sums->count : 1.0;
    error->mae = sums->absolute / n;
    error->mse = sums->squared / n;
    /* An all-black reference has no peak: PSNR is then minus infinity, or infinite if equal. */
    if (sums->squared == 0.0)
        error->psnr = (double)INFINITY;
    else
        error->psnr = 10.0 * log10(sums->peak * sums->peak / error->mse);
}

void hnbrdf_image_compare(const float *image, const float *reference, size_t count,
                          hnbrdf_image_error *error)
{
    image_sums sums = {0};
    for (size_t k = 0; k < count; k++)
        add_value(&sums, (double)image[k], (double)reference[k]);
    finish(&sums, error);
}

/* Let the differences of a pixel be d1 = t + n1 and d2 = t + n2: t without noise, n1 and n2 of
 * mean 0 and covariance C over the channels, independent of each other. With s = (d1 + d2)/2, e =
 * (d1 - d2)/2 the mean picture's error is s.s, on average t.t + tr C/2; e.e is tr C/2 on average,
 * so s.s - e.e = d1.d2 is right on average. Its variance is 2 t'Ct + tr C^2. For normal noise s
 * and e are independent, and (s.e)^2 is on average t'Ct/2 + tr C^2/4: a quarter of that. */
void hnbrdf_image_compare_twice(const float *const image[2], const float *const reference[2],
                                size_t pixels, hnbrdf_image_error *error, hnbrdf_image_noise *noise)
{
    image_sums sums = {0};
    double half_noise = 0.0, variance = 0.0, peak_noise = 0.0;
    for (size_t p = 0; p < pixels; p++) {
        double product = 0.0;
        for (size_t k = 3 * p; k < 3 * p + 3; k++) {
            double r[2] = {(double)reference[0][k], (double)reference[1][k]};
            double d[2] = {(double)image[0][k] - r[0], (double)image[1][k] - r[1]};
            double mean = 0.5 * (r[0] + r[1]), s = 0.5 * (d[0] + d[1]), e = 0.5 * (d[0] - d[1]);
            if (mean > sums.peak)
                peak_noise = 0.5 * fabs(r[0] - r[1]);
            add_value(&sums, mean + s, mean);
            half_noise += e * e;
            product += s * e;
        }
        variance += 4.0 * product * product;
    }
    finish(&sums, error);
    double n = sums.count > 0 ? (double)sums.count : 1.0, decibel = 10.0 / log(10.0);
    noise->mse = error->mse - half_noise / n;
    noise->mse_error = sqrt(variance) / n;
    int equal = sums.squared == 0.0 && half_noise == 0.0;
    noise->psnr_error = noise->psnr_bias = equal ? 0.0 : (double)INFINITY;
    if (error->mse > 0.0) /* error->mse varies a little less than noise->mse, by tr C^2/2 */
        noise->psnr_error = decibel * noise->mse_error / error->mse;
    if (noise->mse > 0.0)
        noise->psnr_bias = decibel * log(error->mse / noise->mse);
    noise->peak_error = sums.peak > 0.0 ? 2.0 * decibel * peak_noise / sums.peak : 0.0;
}
