/* compare_images.h: `hnbrdf compare --images`: how far pictures are from a reference picture. */
#ifndef HNBRDF_REPORT_COMPARE_IMAGES_H
#define HNBRDF_REPORT_COMPARE_IMAGES_H

#include "hnbrdf/hnbrdf.h"
#include "report/flip.h"

#include <stdio.h>

typedef struct compare_images_options {
    char *const *paths; /* [count], the reference last; at least two */
    int count;
    const char *csv, *json; /* where to write the table; NULL: nowhere */
    const char *difference; /* where to draw the difference of the only picture; NULL: nowhere */
    double top;             /* of its scale; 0: chosen */
    const char *layer;      /* of OpenEXR pictures; NULL: the only or main one */
    int repair;             /* see render_read_options */
    report_flip flip;
    report_watch watch; /* of FLIP, which takes seconds */
    hnbrdf_notes notes; /* told of what the files needed to be read */
    FILE *table;        /* gets the table for people and the names of the pictures; NULL: nowhere */
} compare_images_options;

hnbrdf_result compare_images(const compare_images_options *options, hnbrdf_error *error);

#endif
