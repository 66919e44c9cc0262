/* flip.h: FLIP of pictures: what a person sees of their differences. */
#ifndef HNBRDF_REPORT_FLIP_H
#define HNBRDF_REPORT_FLIP_H

#include "image/image.h"
#include "report/watch.h"

typedef struct report_flip {
    double pixels_per_degree; /* as for hnbrdf_flip() */
    double exposure;          /* stops: the only one displayed; NAN: those of HDR-FLIP */
} report_flip;

/* Mean over the pixels that render_covered() counts, premultiplied, whose median luminance the
 * exposures are of; pictures of the same size. watch may be NULL; one that says stop ends it with
 * HNBRDF_ERROR_CANCELLED. */
hnbrdf_result report_flip_compare(const render_image *image, const render_image *reference,
                                  const report_flip *options, const report_watch *watch,
                                  double *flip, hnbrdf_error *error);

#endif
