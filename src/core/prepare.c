/* prepare.c: what is computed once a material, so that evaluation, sampling and the density need
 * not. */
#include "core/carry.h"
#include "core/kernel.h"
#include "core/prepared.h"

HNBRDF_DIVIDES_AS_IEEE
float hnbrdf_specular_share(int neural, const hnbrdf_material *material)
{
    if (neural)
        return 0.0f;
    float specular = 0.05f, diffuse = 0.0f;
    for (int c = 0; c < 3; c++) {
        float r = (material->eta[c] - 1.0f) / (material->eta[c] + 1.0f);
        specular += r * r * (1.0f / 3.0f);
        diffuse += material->kd[c] * (1.0f / 3.0f);
    }
    return hnbrdf_clamp(specular / (specular + diffuse), 0.2f, 0.9f);
}

static hnbrdf_prepared_edit prepare_edit(const hnbrdf_material *material)
{
    const hnbrdf_fitted *fitted = &material->fitted;
    hnbrdf_prepared_edit edit;
    for (int k = 0; k < 2; k++) {
        edit.alpha[k] = fitted->alpha[k];
        edit.warp[k] = hnbrdf_warp_factor(material->alpha[k], fitted->alpha[k]);
    }
    edit.area = hnbrdf_ggx_area(fitted->alpha[0], fitted->alpha[1]);
    for (int c = 0; c < 4; c++) {
        int channel = c < 3 ? c : 2;
        float kd = material->kd[channel], fitted_kd = fitted->kd[channel];
        edit.diffuse[c] = fitted_kd * HNBRDF_INV_PI;
        edit.carried[c] = hnbrdf_carried_kd(kd, fitted_kd) * HNBRDF_INV_PI;
        edit.added[c] = hnbrdf_added_kd(kd, fitted_kd) * HNBRDF_INV_PI;
        edit.e[c] =
            hnbrdf_fresnel_e(hnbrdf_carried_eta(material->eta[channel], fitted->eta[channel]));
    }
    return edit;
}

void hnbrdf_prepare_analytic(const hnbrdf_model *model, const hnbrdf_material *material,
                             hnbrdf_prepared *prepared)
{
    hnbrdf_frame frame = hnbrdf_frame_of(material);
    prepared->model = model;
    prepared->cosine = frame.cosine;
    prepared->sine = frame.sine;
    for (int k = 0; k < 2; k++)
        prepared->alpha[k] = material->alpha[k];
    prepared->area = hnbrdf_ggx_area(material->alpha[0], material->alpha[1]);
    for (int c = 0; c < 4; c++) {
        int channel = c < 3 ? c : 2;
        prepared->diffuse[c] = material->kd[channel] * HNBRDF_INV_PI;
        prepared->e[c] = hnbrdf_fresnel_e(material->eta[channel]);
    }
    prepared->edited = model->desc.kind == HNBRDF_KIND_HYBRID && hnbrdf_is_edited(material);
    if (prepared->edited)
        prepared->edit = prepare_edit(material);
    prepared->energy = hnbrdf_energy_used(&material->energy);
    prepared->conserved = hnbrdf_has_energy(&material->energy);
}

void hnbrdf_lobes_used(int neural, const hnbrdf_material *material, hnbrdf_lobes *lobes)
{
    *lobes = material->lobes;
    if (lobes->scale[0] == 0.0f) {
        float share = hnbrdf_specular_share(neural, material);
        for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
            lobes->share[0][j] = share;
        lobes->scale[0] = 1.0f;
        lobes->scale[1] = 0.0f;
    }
    for (int k = 0; k < HNBRDF_LOBES; k++)
        for (int j = 0; j < HNBRDF_LOBE_KNOTS && lobes->scale[k] == 0.0f; j++)
            lobes->share[k][j] = 0.0f;
}

void hnbrdf_prepare_lobes(const hnbrdf_model *model, const hnbrdf_material *material,
                          hnbrdf_prepared *prepared)
{
    int neural = model->desc.kind == HNBRDF_KIND_NEURAL;
    hnbrdf_lobes_used(neural, material, &prepared->lobes);
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        float *alpha = prepared->lobe_alpha[k];
        for (int a = 0; a < 2; a++)
            alpha[a] =
                hnbrdf_clamp(fabsf(prepared->lobes.scale[k]) * (neural ? 1.0f : material->alpha[a]),
                             HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
        prepared->lobe_area[k] = hnbrdf_ggx_area(alpha[0], alpha[1]);
    }
}

void hnbrdf_prepare_eval(const hnbrdf_model *model, const hnbrdf_material *material,
                         hnbrdf_prepared *prepared)
{
    hnbrdf_prepare_analytic(model, material, prepared);
    if (model->desc.kind != HNBRDF_KIND_GGX)
        model->kernel->fold(model, material->latent, prepared->first);
}

void hnbrdf_prepare(const hnbrdf_model *model, const hnbrdf_material *material,
                    hnbrdf_prepared *prepared)
{
    hnbrdf_prepare_eval(model, material, prepared);
    hnbrdf_prepare_lobes(model, material, prepared);
}
