/* published.c: a network in the style of the published shaders. The same sums as in the other
 * styles, in the order that a matrix times a vector has. */
#include "glsl/published.h"

/* ---- Groups ---------------------------------------------------------------------------------- */

/* Of `left` numbers: four, or so many that no single one is left, which is no vector. */
static int group_size(int left)
{
    return left == 5 ? 3 : left < 4 ? left : 4;
}

/* ---- Layers ---------------------------------------------------------------------------------- */

static void put_inputs(hnbrdf_printer *out, const hnbrdf_model_desc *desc,
                       hnbrdf_put_input_fn put_input)
{
    int count = hnbrdf_layer_inputs(desc, 0);
    for (int first = 0, group = 0; first < count; group++) {
        int size = group_size(count - first);
        hnbrdf_put(out, "    vec%d f0_%d = vec%d(", size, group, size);
        for (int i = first; i < first + size; i++) {
            hnbrdf_put(out, "%s", i > first ? ", " : "");
            put_input(out, desc, i);
        }
        hnbrdf_put(out, ");\n");
        first += size;
    }
}

/* mat4(...) * fL_K: `rows` rows from `row` on, `columns` inputs from `column` on; column by
 * column. */
static void put_product(hnbrdf_printer *out, const hnbrdf_model_desc *desc, int layer, int row,
                        int rows, int column, int columns)
{
    const float *weights = desc->weights[layer];
    int inputs = hnbrdf_layer_inputs(desc, layer);
    if (columns == rows)
        hnbrdf_put(out, "mat%d(", rows);
    else
        hnbrdf_put(out, "mat%dx%d(", columns, rows);
    for (int k = 0; k < rows * columns; k++) {
        hnbrdf_put(out, "%s", k ? ", " : "");
        hnbrdf_put_float(out, weights[(row + k % rows) * inputs + column + k / rows]);
    }
    hnbrdf_put(out, ")");
}

static void put_rows(hnbrdf_printer *out, const hnbrdf_model_desc *desc, int layer, int row,
                     int rows, int group)
{
    int hidden = layer < desc->layers, inputs = hnbrdf_layer_inputs(desc, layer);
    hnbrdf_put(out, "    vec%d f%d_%d = %s", rows, layer + 1, group, hidden ? "hardGeLU(" : "");
    for (int column = 0, block = 0; column < inputs; block++) {
        int columns = group_size(inputs - column);
        put_product(out, desc, layer, row, rows, column, columns);
        hnbrdf_put(out, " * f%d_%d + ", layer, block);
        column += columns;
    }
    hnbrdf_put_vector(out, rows, desc->biases[layer] + row, rows);
    hnbrdf_put(out, "%s", hidden ? ");\n" : ";\n");
}

void hnbrdf_put_published_network(hnbrdf_printer *out, const hnbrdf_model_desc *desc,
                                  hnbrdf_put_input_fn put_input)
{
    put_inputs(out, desc, put_input);
    for (int layer = 0; layer <= desc->layers; layer++) {
        int outputs = hnbrdf_layer_outputs(desc, layer);
        for (int row = 0, group = 0; row < outputs; group++) {
            int rows = group_size(outputs - row);
            put_rows(out, desc, layer, row, rows, group);
            row += rows;
        }
    }
}
