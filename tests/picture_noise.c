/* picture_noise.c A1 A2 B1 B2: do two renderers agree? A1 and A2 are one's picture with two seeds,
 * B1 and B2 the other's. Exit status 0: they do, as far as their own noise lets see; 1: they do
 * not; 2: the pictures cannot be compared.
 *
 * The mean of (A1 - B1)(A2 - B2) over all pixels estimates the squared difference of the two
 * without noise, as the noise of its factors is independent. Its standard error comes from its
 * spread over the pixels, and that of the mean difference of a channel from the differences between
 * the pictures of one renderer. Each is allowed four standard errors: of all four limits one is
 * passed by chance in 1 of 5,000 tries at most. */
#include "image/image.h"

#include <math.h>
#include <stdio.h>

enum { A1, A2, B1, B2, PICTURES };

static double value(const render_image *image, size_t k)
{
    return (double)image->rgb[k];
}

int main(int argc, char **argv)
{
    render_image images[PICTURES] = {{0}};
    hnbrdf_error error;
    double sum[3] = {0}, noise[3] = {0}, products = 0.0, squares = 0.0, light = 0.0;
    if (argc != 1 + PICTURES)
        return fprintf(stderr, "usage: %s A1 A2 B1 B2\n", argv[0]), 2;
    for (int i = 0; i < PICTURES; i++) {
        if (render_image_read(argv[1 + i], NULL, &images[i], &error))
            return fprintf(stderr, "%s\n", error.text), 2;
        if (images[i].width != images[0].width || images[i].height != images[0].height)
            return fprintf(stderr, "%s: another size than %s\n", argv[1 + i], argv[1]), 2;
    }
    const size_t pixels = (size_t)images[0].width * (size_t)images[0].height;
    for (size_t pixel = 0; pixel < pixels; pixel++) {
        double product = 0.0;
        for (size_t c = 0; c < 3; c++) {
            const size_t k = 3 * pixel + c;
            const double a1 = value(&images[A1], k), a2 = value(&images[A2], k);
            const double b1 = value(&images[B1], k), b2 = value(&images[B2], k);
            sum[c] += 0.5 * (a1 + a2 - b1 - b2);
            noise[c] += 0.25 * ((a1 - a2) * (a1 - a2) + (b1 - b2) * (b1 - b2));
            product += (a1 - b1) * (a2 - b2) / 3.0;
            light += 0.5 * (b1 + b2) / 3.0;
        }
        products += product;
        squares += product * product;
    }
    const double n = (double)pixels, mean = light / n, squared = products / n;
    const double spread = sqrt(fmax(0.0, squares / n - squared * squared) / n);
    int agree = squared < 4.0 * spread;
    printf("difference^2 %.2e, standard error %.2e, of a mean of %.3f: at most %.1f %%\n", squared,
           spread, mean, 100.0 * sqrt(fmax(0.0, squared) + 4.0 * spread) / mean);
    for (int c = 0; c < 3; c++) {
        const double z = sum[c] / sqrt(noise[c]);
        agree &= fabs(z) < 4.0;
        printf("channel %d: mean difference %+.2e, %+.1f standard errors\n", c, sum[c] / n, z);
    }
    for (int i = 0; i < PICTURES; i++)
        render_image_free(&images[i]);
    return !agree;
}
