/* test_render_sheet.c: lettering and the layout of contact sheets. */
#include "image/label.h"
#include "image/sheet.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const float ink[3] = {1.0f, 1.0f, 1.0f};

/* Columns and rows that hold any ink. */
static void bounds(const render_image *image, int *left, int *right, int *top, int *bottom)
{
    *left = image->width;
    *top = image->height;
    *right = *bottom = -1;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            if (image->rgb[3 * (y * image->width + x)] > 0.05f) {
                *left = x < *left ? x : *left;
                *right = x > *right ? x : *right;
                *top = y < *top ? y : *top;
                *bottom = y > *bottom ? y : *bottom;
            }
}

static void every_character_has_a_shape_inside_its_box(void **state)
{
    (void)state;
    for (int c = 0x21; c <= 0x7e; c++) {
        char text[2] = {(char)c, 0};
        render_image image;
        int left, right, top, bottom;
        assert_int_equal(render_image_create(60, 60, 0, &image, NULL), HNBRDF_OK);
        render_text(&image, 20, 35, text, 10.0, ink);
        bounds(&image, &left, &right, &top, &bottom);
        assert_true(right >= left && left >= 19);
        assert_true(right <= 20 + render_text_width(text, 10.0) + 1.0);
        assert_true(top >= 35 - 17 && bottom <= 35 + 6);
        render_image_free(&image);
    }
}

static void no_two_characters_look_alike(void **state)
{
    (void)state;
    for (unsigned a = 0x20; a <= 0x7e; a++)
        for (unsigned b = a + 1; b <= 0x7e; b++) {
            const render_glyph *g = render_glyph_find(a), *h = render_glyph_find(b);
            assert_true(g->width != h->width || strcmp(g->path, h->path) != 0);
        }
}

static void text_is_clipped_to_the_image(void **state)
{
    (void)state;
    render_image image;
    assert_int_equal(render_image_create(9, 7, 1, &image, NULL), HNBRDF_OK);
    for (int x = -30; x < 30; x += 3)
        for (int y = -30; y < 30; y += 3)
            render_text(&image, x, y, "Wg@", 8.0, ink); /* ASan sees a step outside */
    for (int i = 0; i < 3 * 63; i++)
        assert_true(image.rgb[i] >= 0.0f && image.rgb[i] <= 1.0f);
    render_image_free(&image);
}

static void broken_utf8_is_drawn_as_boxes(void **state)
{
    (void)state;
    static const char *const texts[] = {"\x80",     "\xff\xfe",     "\xc3",
                                        "\xe2\x80", "\xf0\x9f\x98", "a\xc3z"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        render_image image;
        assert_int_equal(render_image_create(80, 40, 0, &image, NULL), HNBRDF_OK);
        assert_true(render_text_width(texts[i], 10.0) > 0.0);
        render_text(&image, 5, 25, texts[i], 10.0, ink);
        render_image_free(&image);
    }
    assert_true(render_text_width("\xc3\xa9", 10.0) ==
                render_text_width("\xff", 10.0)); /* one box each */
}

static void long_names_are_shortened_to_fit(void **state)
{
    (void)state;
    static const char name[] =
        "acrylic_felt_orange_from_a_very_long_file_name_\xc3\xa9\xc3\xa9\xc3\xa9";
    for (double width = 30.0; width < 500.0; width += 7.0)
        for (size_t size = 8; size < 100; size += 13) {
            char text[100];
            render_text_shorten(name, 8.0, width, text, size);
            assert_true(strlen(text) < size);
            assert_true(render_text_width(text, 8.0) <= width);
            if (strcmp(text, name) != 0) {
                size_t kept = strlen(text) - 3;
                assert_int_equal(memcmp(text + kept, "\xe2\x80\xa6", 3), 0);
                assert_int_equal(memcmp(text, name, kept), 0);
            }
        }
    char text[100];
    render_text_shorten("short", 8.0, 500.0, text, sizeof text);
    assert_string_equal(text, "short");
}

static render_image compose(int count, int columns, int cell, int blocks)
{
    render_sheet_row *rows = calloc((size_t)count, sizeof *rows);
    for (int i = 0; i < count; i++) {
        rows[i].name = "a name that is much too long for the card of a small cell";
        for (int c = 0; c < columns; c++) {
            assert_int_equal(render_image_create(cell, cell, 0, &rows[i].cells[c].image, NULL),
                             HNBRDF_OK);
            for (int k = 0; k < 3 * cell * cell; k++)
                rows[i].cells[c].image.rgb[k] = 1.0f + (float)(i * columns + c);
            strcpy(rows[i].cells[c].caption, "MAE 0.1234  31.2 dB");
            strcpy(rows[i].cells[c].short_caption, "31.2 dB");
        }
    }
    render_sheet sheet = {
        .lines = {"title", "a second line that is far too long for a narrow page of one card"},
        .titles = {"reference", "GGX alone", "hybrid", "error", "error"},
        .columns = columns,
        .cell = cell,
        .blocks = blocks,
        .rows = rows,
        .count = count};
    render_image image;
    assert_int_equal(render_sheet_compose(&sheet, &image, NULL), HNBRDF_OK);
    for (int i = 0; i < count; i++)
        for (int c = 0; c < columns; c++)
            render_image_free(&rows[i].cells[c].image);
    free(rows);
    return image;
}

/* No picture is covered by another one or by text: each keeps all its pixels. */
static void every_cell_is_whole(void **state)
{
    (void)state;
    static const int cells[] = {32, 40, 77, 160};
    for (int count = 1; count <= 11; count += 5)
        for (int columns = 1; columns <= RENDER_SHEET_COLUMNS; columns += 4)
            for (size_t s = 0; s < sizeof cells / sizeof *cells; s++)
                for (int blocks = 0; blocks <= 3; blocks++) {
                    render_image image = compose(count, columns, cells[s], blocks);
                    int *seen = calloc((size_t)(count * columns) + 1, sizeof *seen);
                    for (int i = 0; i < image.width * image.height; i++) {
                        int value = (int)image.rgb[3 * i];
                        assert_true(value <= count * columns);
                        seen[value]++;
                    }
                    for (int i = 1; i <= count * columns; i++)
                        assert_int_equal(seen[i], cells[s] * cells[s]);
                    free(seen);
                    render_image_free(&image);
                }
}

static void many_materials_make_a_page_of_about_three_by_two(void **state)
{
    (void)state;
    static const int counts[] = {12, 16, 51, 100};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        render_image image = compose(counts[i], 3, 48, 0);
        double aspect = (double)image.width / image.height;
        assert_true(aspect > 0.9 && aspect < 2.5);
        render_image_free(&image);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_character_has_a_shape_inside_its_box),
        cmocka_unit_test(no_two_characters_look_alike),
        cmocka_unit_test(text_is_clipped_to_the_image),
        cmocka_unit_test(broken_utf8_is_drawn_as_boxes),
        cmocka_unit_test(long_names_are_shortened_to_fit),
        cmocka_unit_test(every_cell_is_whole),
        cmocka_unit_test(many_materials_make_a_page_of_about_three_by_two),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
