// evaluate.cpp: a C++ program that knows nothing but the installed hnbrdf.h.
#include <hnbrdf/hnbrdf.h>

#include <cmath>
#include <cstdio>
#include <memory>

struct Free {
    void operator()(hnbrdf_model *model) const
    {
        hnbrdf_model_free(model);
    }
};

int main()
{
    hnbrdf_material material;
    hnbrdf_material_init(&material);
    const char *name = "plain";
    hnbrdf_model_desc desc = hnbrdf_model_desc();
    desc.kind = HNBRDF_KIND_GGX;
    desc.material_count = 1;
    desc.materials = &material;
    desc.names = &name;
    hnbrdf_model *raw = nullptr;
    hnbrdf_error error;
    if (hnbrdf_model_create(&desc, nullptr, &raw, &error) != HNBRDF_OK) {
        std::fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    const std::unique_ptr<hnbrdf_model, Free> model(raw);
    const float wo[3] = {0.6f, 0.0f, 0.8f}, u[2] = {0.25f, 0.75f};
    hnbrdf_sample_result sample;
    hnbrdf_sample(model.get(), &material, wo, u, &sample);
    const float pdf = hnbrdf_pdf(model.get(), &material, sample.wi, wo);
    return pdf > 0.0f && std::isfinite(pdf) && pdf == sample.pdf ? 0 : 1;
}
