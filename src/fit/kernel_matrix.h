/* kernel_matrix.h: a product of small matrices, for the part of a step that is not in tiles
 * (soap.c). Included by kernel_body.h.
 *
 * What is left of whole blocks and vectors is made by a last one that overlaps the one before: the
 * same numbers twice cost less than a second path. */

/* c = a b for `rows` of a and KERNEL_WIDTH columns of b; rows is a constant where this is
 * inlined. */
static inline __attribute__((always_inline)) void matrix_block(const REAL *restrict a, int depth,
                                                               const REAL *restrict b, int columns,
                                                               REAL *restrict c, int rows)
{
    vector sums[KERNEL_ROWS];
    memset(sums, 0, sizeof sums);
    for (int k = 0; k < depth; k++) {
        const vector row = *(const vector *)(b + k * columns);
        for (int r = 0; r < rows; r++)
            sums[r] += row * a[r * depth + k];
    }
    for (int r = 0; r < rows; r++)
        *(vector *)(c + r * columns) = sums[r];
}

/* columns >= KERNEL_WIDTH */
static void matrix_wide(const REAL *restrict a, const REAL *restrict b, REAL *restrict c, int rows,
                        int depth, int columns)
{
    for (int u = 0; u < columns; u += KERNEL_WIDTH) {
        const int at = u + KERNEL_WIDTH <= columns ? u : columns - KERNEL_WIDTH;
        for (int r = 0; rows >= KERNEL_ROWS && r < rows; r += KERNEL_ROWS) {
            const int from = r + KERNEL_ROWS <= rows ? r : rows - KERNEL_ROWS;
            matrix_block(a + from * depth, depth, b + at, columns, c + from * columns + at,
                         KERNEL_ROWS);
        }
        for (int r = 0; rows < KERNEL_ROWS && r < rows; r++)
            matrix_block(a + r * depth, depth, b + at, columns, c + r * columns + at, 1);
    }
}

/* See fit_kernel.matrix. */
static void kernel_matrix(const REAL *restrict a, const REAL *restrict b, REAL *restrict c,
                          int rows, int depth, int columns)
{
    REAL wide_b[FIT_MATRIX * KERNEL_WIDTH], wide_c[FIT_MATRIX * KERNEL_WIDTH];
    if (columns >= KERNEL_WIDTH) {
        matrix_wide(a, b, c, rows, depth, columns);
        return;
    }
    memset(wide_b, 0, sizeof(REAL) * (size_t)(depth * KERNEL_WIDTH));
    for (int k = 0; k < depth; k++)
        for (int j = 0; j < columns; j++)
            wide_b[k * KERNEL_WIDTH + j] = b[k * columns + j];
    matrix_wide(a, wide_b, wide_c, rows, depth, KERNEL_WIDTH);
    for (int r = 0; r < rows; r++)
        for (int j = 0; j < columns; j++)
            c[r * columns + j] = wide_c[r * KERNEL_WIDTH + j];
}
