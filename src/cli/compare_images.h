/* compare_images.h: `hnbrdf compare --images`: how far pictures are from a reference picture. */
#ifndef HNBRDF_CLI_COMPARE_IMAGES_H
#define HNBRDF_CLI_COMPARE_IMAGES_H

typedef struct compare_images_options {
    char *const *paths; /* [count], the reference last; at least two */
    int count;
    const char *csv, *json; /* where to write the table; NULL: nowhere */
    const char *difference; /* where to draw the difference of the only picture; NULL: nowhere */
    double top;             /* of its scale; 0: chosen */
} compare_images_options;

/* 0, or CLI_FAILURE after a message. */
int compare_images(const compare_images_options *options);

#endif
