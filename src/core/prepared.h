/* prepared.h: what evaluation and sampling share of a prepared material: its parts, and f_a from
 * it. */
#ifndef HNBRDF_CORE_PREPARED_H
#define HNBRDF_CORE_PREPARED_H

#include "core/compose.h"
#include "core/encoding.h"
#include "core/frame.h"
#include "core/microfacet.h"
#include "core/model.h"

/* Everything but the lobes and first. */
void hnbrdf_prepare_analytic(const hnbrdf_model *model, const hnbrdf_material *material,
                             hnbrdf_prepared *prepared);

/* All that evaluation needs: everything but the lobes. */
void hnbrdf_prepare_eval(const hnbrdf_model *model, const hnbrdf_material *material,
                         hnbrdf_prepared *prepared);

/* Share of samples that go to the GGX lobe where no lobes were fitted: reflectance at normal
 * incidence, raised a little for what Fresnel adds towards grazing, against the diffuse albedo. 0
 * where there is no analytic part. */
float hnbrdf_specular_share(int neural, const hnbrdf_material *material);

/* The lobes that are sampled: those of the material, or guessed ones where it has none; a lobe of
 * scale 0 has no share. */
void hnbrdf_lobes_used(int neural, const hnbrdf_material *material, hnbrdf_lobes *lobes);
/* lobe_alpha, lobe_area and lobes: all that sampling adds. */
void hnbrdf_prepare_lobes(const hnbrdf_model *model, const hnbrdf_material *material,
                          hnbrdf_prepared *prepared);

/* hnbrdf_prepared_draw() with the azimuth turned by `turn`, in [0, 1). */
float hnbrdf_prepared_draw_turned(const hnbrdf_prepared *prepared, const float wo[3], float u0,
                                  float u1, float turn, float wi[3]);

static inline int hnbrdf_above_horizon(const float wi[3], const float wo[3])
{
    return wi[2] > 0.0f && wo[2] > 0.0f;
}

static inline hnbrdf_pair hnbrdf_pair_in_frame(const hnbrdf_prepared *prepared, const float wi[3],
                                               const float wo[3])
{
    const hnbrdf_frame frame = {prepared->cosine, prepared->sine};
    float i[3], o[3];
    hnbrdf_to_tangent(frame, wi, i);
    hnbrdf_to_tangent(frame, wo, o);
    return hnbrdf_pair_make(i, o);
}

/* f with the factor of a material that conserves energy. */
static inline void hnbrdf_prepared_conserve(const hnbrdf_prepared *prepared, const float wi[3],
                                            const float wo[3], float f[3])
{
    const hnbrdf_energy *energy = &prepared->energy;
    const float k = hnbrdf_energy_factor(energy->horizon, energy->slope, wi[2], wo[2]);
    for (int c = 0; c < 3; c++)
        f[c] = f[c] * k;
}

/* The pair that the network of an edited material sees; f_a of the three channels, kd only as far
 * as it carries the correction along, and of the fitted material at that pair, the angles of
 * incidence being those of `pair`. The fourth fills a vector. */
static inline hnbrdf_pair hnbrdf_prepared_edited(const hnbrdf_prepared *prepared,
                                                 const hnbrdf_pair *pair, float edited[4],
                                                 float fitted[4])
{
    const hnbrdf_prepared_edit *edit = &prepared->edit;
    float now =
        hnbrdf_specular_of_area(pair, prepared->alpha[0], prepared->alpha[1], prepared->area);
    float specular[4];
    for (int c = 0; c < 4; c++) {
        specular[c] = hnbrdf_fresnel_of_e(prepared->e[c], pair->c) * now;
        edited[c] = edit->carried[c] + specular[c];
    }
    const hnbrdf_pair seen =
        hnbrdf_seen(prepared->model->desc.encoding, pair, edit->warp[0], edit->warp[1],
                    hnbrdf_specular_part(specular, edit->carried));
    float before = hnbrdf_fitted_specular(pair, &seen, edit->alpha[0], edit->alpha[1], edit->area);
    for (int c = 0; c < 4; c++)
        fitted[c] = hnbrdf_microfacet_of(edit->diffuse[c], edit->e[c], pair->c, before);
    return seen;
}

/* The pair that the network sees, edited or not. */
static inline hnbrdf_pair hnbrdf_prepared_seen(const hnbrdf_prepared *prepared,
                                               const hnbrdf_pair *pair)
{
    float edited[4], fitted[4];
    return prepared->edited ? hnbrdf_prepared_edited(prepared, pair, edited, fitted) : *pair;
}

/* The edit of a material, or of an unedited one what changes no bit: for where both kinds are
 * evaluated together. */
static inline hnbrdf_prepared_edit hnbrdf_edit_of(const hnbrdf_prepared *prepared)
{
    hnbrdf_prepared_edit edit = {.warp = {1.0f, 1.0f},
                                 .alpha = {prepared->alpha[0], prepared->alpha[1]},
                                 .area = prepared->area};
    if (prepared->edited)
        return prepared->edit;
    for (int c = 0; c < 4; c++) {
        edit.diffuse[c] = edit.carried[c] = prepared->diffuse[c];
        edit.e[c] = prepared->e[c];
    }
    return edit;
}

/* f_a of the three channels; the fourth fills a vector and repeats the third. */
static inline void hnbrdf_prepared_analytic(const hnbrdf_prepared *prepared,
                                            const hnbrdf_pair *pair, float f[4])
{
    float specular =
        hnbrdf_specular_of_area(pair, prepared->alpha[0], prepared->alpha[1], prepared->area);
    for (int c = 0; c < 4; c++)
        f[c] = hnbrdf_microfacet_of(prepared->diffuse[c], prepared->e[c], pair->c, specular);
}

#endif
