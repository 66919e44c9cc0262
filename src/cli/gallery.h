/* gallery.h: what the parts of `hnbrdf gallery` share: strips of edited materials, and pages of
 * them. */
#ifndef HNBRDF_CLI_GALLERY_H
#define HNBRDF_CLI_GALLERY_H

#include "cli/picture.h"
#include "image/sheet.h"

enum { GALLERY_EDITS = 7, GALLERY_PAIRS = 32, GALLERY_MATERIALS = 32 };

typedef struct gallery {
    const char *directory, *model_path;
    hnbrdf_model *model;
    hnbrdf_model_desc desc;
    cli_data data; /* measurements to show beside, maybe none */
    picture_options light;
    long size;
    int materials[GALLERY_MATERIALS], material_count; /* whose edits are shown */
    int pairs[GALLERY_PAIRS][2], pair_count;          /* between which materials are mixed */
    render_environment environment;
    hnbrdf_model *guide; /* see render_guide_model() */
    picture_progress progress;
} gallery;

/* ---- gallery_strips.c: edits of one material, side by side, the unedited one first ----------- */

typedef struct gallery_strip {
    hnbrdf_material materials[GALLERY_EDITS];
    char captions[GALLERY_EDITS][48];
    char command[160]; /* what `hnbrdf edit` or `mix` is given for the last one */
} gallery_strip;

/* Roughness, diffuse colour, index of refraction; one roughness along and another across. */
void gallery_strip_alpha(const hnbrdf_material *material, gallery_strip *strip);
void gallery_strip_kd(const hnbrdf_material *material, gallery_strip *strip);
void gallery_strip_eta(const hnbrdf_material *material, gallery_strip *strip);
void gallery_strip_anisotropy(const hnbrdf_material *material, gallery_strip *strip);
/* From a to b. */
void gallery_strip_mix(const hnbrdf_material *a, const hnbrdf_material *b, gallery_strip *strip);

/* ---- gallery_choose.c: 0, or CLI_FAILURE after a message ------------------------------------- */

/* The `most` materials in which GGX and network both matter: that answer to edits of their GGX
 * part, and are not GGX alone. */
int gallery_choose_materials(gallery *g, int most);
/* Up to `most` pairs of materials, those that are farthest apart, each material once. */
int gallery_choose_pairs(gallery *g, int most);

/* ---- gallery_pages.c: likewise --------------------------------------------------------------- */

/* Renders and writes all pages, and gallery.md. */
int gallery_write(gallery *g);

#endif
