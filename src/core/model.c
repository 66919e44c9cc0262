/* model.c: what a model holds, for who asks. */
#include "core/model.h"

void hnbrdf_model_describe(const hnbrdf_model *model, hnbrdf_model_desc *desc)
{
    *desc = model->desc;
}

int hnbrdf_model_material_count(const hnbrdf_model *model)
{
    return model->desc.material_count;
}

const hnbrdf_material *hnbrdf_model_material(const hnbrdf_model *model, int index)
{
    return index >= 0 && index < model->desc.material_count ? &model->desc.materials[index] : NULL;
}

const char *hnbrdf_model_material_name(const hnbrdf_model *model, int index)
{
    return index >= 0 && index < model->desc.material_count ? model->desc.names[index] : NULL;
}
