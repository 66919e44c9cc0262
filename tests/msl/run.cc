// run.cc: runs a case of `hnbrdf verify --language msl --hand-out` on the host, with metal_stdlib
// of this folder in the place of Apple's. Compiled with the case in the include path and with
// CASE_SCENE, CASE_PARITY, CASE_OUTPUTS and, of an exact build, CASE_PROBE; CASE_WEIGHTS where
// parity takes the weights. Reads and writes files of the working directory.
#include CASE_SCENE
#include CASE_PARITY

#include <cstdio>
#include <cstdlib>
#include <vector>

enum { INPUTS = 4, SLOTS = 8, PROBE_SLOTS = 2 };

static std::vector<float4> read(const char *name)
{
    std::vector<float4> rows;
    std::FILE *file = std::fopen(name, "rb");
    float4 row;
    while (file && std::fread(row.at, sizeof row.at, 1, file) == 1)
        rows.push_back(row);
    if (!file || std::ferror(file) || rows.empty()) {
        std::fprintf(stderr, "run: %s cannot be read\n", name);
        std::exit(1);
    }
    std::fclose(file);
    return rows;
}

static void write(const char *name, const std::vector<float4> &rows)
{
    std::FILE *file = std::fopen(name, "wb");
    const bool written =
        file && std::fwrite(rows[0].at, sizeof rows[0].at, rows.size(), file) == rows.size();
    if (!file || std::fclose(file) != 0 || !written) {
        std::fprintf(stderr, "run: %s cannot be written\n", name);
        std::exit(1);
    }
}

int main()
{
    const std::vector<float4> rows = read("inputs.f32");
    std::vector<float4> outputs;
#ifdef CASE_WEIGHTS
    const std::vector<float4> weights = read("weights.bin");
#endif
    for (std::size_t k = 0; k + INPUTS <= rows.size(); k += INPUTS)
        for (int slot = 0; slot < SLOTS; slot++)
#ifdef CASE_WEIGHTS
            outputs.push_back(hnbrdf_parity(rows[k], rows[k + 1], rows[k + 2], rows[k + 3], slot,
                                            weights.data()));
#else
            outputs.push_back(hnbrdf_parity(rows[k], rows[k + 1], rows[k + 2], rows[k + 3], slot));
#endif
    write(CASE_OUTPUTS, outputs);
#ifdef CASE_PROBE
    std::vector<float4> results;
    for (const float4 &operands : read("probe.f32"))
        for (int slot = 0; slot < PROBE_SLOTS; slot++)
            results.push_back(hnbrdf_probe(operands, slot));
    write("probe_results.f32", results);
#endif
    return 0;
}
