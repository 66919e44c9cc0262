/* same_picture.c: whether two pictures are the same to the bit, and what differs if not. */
#include "report/same_picture.h"

#include "report/picture.h"

#include <math.h>

static void add(report_same_picture *s, float a, float b)
{
    s->count++;
    s->differ += a != b;
    s->apart += a != b && nextafterf(a, b) != b;
}

hnbrdf_result report_same_picture_measure(const render_image *a, const render_image *b,
                                          report_same_picture *same, hnbrdf_error *error)
{
    report_same_picture s = {.psnr = (double)INFINITY};
    hnbrdf_image_error difference;
    size_t pixels = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < pixels; i++) {
        for (size_t k = 0; k < 3; k++)
            add(&s, a->rgb[3 * i + k], b->rgb[3 * i + k]);
        add(&s, a->alpha[i], b->alpha[i]);
    }
    if (s.differ) {
        hnbrdf_result result = report_picture_compare(a, b, &difference, error);
        if (result)
            return result;
        s.psnr = difference.psnr;
    }
    *same = s;
    return HNBRDF_OK;
}

void report_same_picture_print(const report_same_picture *same, int exact, FILE *file)
{
    if (same->differ == 0) {
        fprintf(file, "check: all %zu numbers of the picture are the CPU's, to the bit\n",
                same->count);
        return;
    }
    fprintf(file,
            "check: %zu of %zu numbers of the picture differ from the CPU's, %zu by more than one "
            "step of a float; PSNR %.1f dB\n",
            same->differ, same->count, same->apart, same->psnr);
    if (!exact)
        fprintf(file, "check: this device does not round + - * / sqrt as C does, its samples are "
                      "not the CPU's\n");
}
