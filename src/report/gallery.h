/* gallery.h: pages of spheres that show what can be done with fitted materials: strips of edited
 * materials, and the way from one material to another. */
#ifndef HNBRDF_REPORT_GALLERY_H
#define HNBRDF_REPORT_GALLERY_H

#include "report/spheres.h"

enum { REPORT_GALLERY_EDITS = 7, REPORT_GALLERY_PAIRS = 32, REPORT_GALLERY_MATERIALS = 32 };

typedef struct report_gallery {
    const char *directory, *model_path;
    const hnbrdf_model *model;
    hnbrdf_model_desc desc; /* of the model */
    report_spheres spheres; /* opened; its data are shown beside, maybe none */
    int materials[REPORT_GALLERY_MATERIALS], material_count; /* whose edits are shown */
    int pairs[REPORT_GALLERY_PAIRS][2], pair_count;          /* between which materials are mixed */
} report_gallery;

/* ---- gallery_strips.c: edits of one material, side by side, the unedited one first ----------- */

typedef struct report_strip {
    hnbrdf_material materials[REPORT_GALLERY_EDITS];
    char captions[REPORT_GALLERY_EDITS][48];
    char command[160]; /* what `hnbrdf edit` or `mix` is given for the last one */
} report_strip;

/* Roughness, diffuse colour, index of refraction; one roughness along and another across. */
void report_strip_alpha(const hnbrdf_material *material, report_strip *strip);
void report_strip_kd(const hnbrdf_material *material, report_strip *strip);
void report_strip_eta(const hnbrdf_material *material, report_strip *strip);
void report_strip_anisotropy(const hnbrdf_material *material, report_strip *strip);
/* From a to b, on a path of hnbrdf_mix_path_fit(). */
hnbrdf_result report_strip_mix(const hnbrdf_model *model, const hnbrdf_material *a,
                               const hnbrdf_material *b, report_strip *strip, hnbrdf_error *error);

/* ---- gallery_choose.c ------------------------------------------------------------------------ */

/* The `most` materials in which GGX and network both matter: that answer to edits of their GGX
 * part, and are not GGX alone. */
hnbrdf_result report_gallery_choose_materials(report_gallery *g, int most, hnbrdf_error *error);
/* Up to `most` pairs of materials, those that are farthest apart, each material once. */
hnbrdf_result report_gallery_choose_pairs(report_gallery *g, int most, hnbrdf_error *error);

/* ---- gallery_pages.c ------------------------------------------------------------------------- */

/* Renders and writes all pages, and gallery.md; tells the path of each. */
hnbrdf_result report_gallery_write(report_gallery *g, hnbrdf_error *error);

#endif
