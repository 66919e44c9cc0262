/* test_measured_known.c: SHA-256 gives the digests of its standard, and a MERL file is only
 * recognised by its checksum. No published file was at hand: that one is recognised rests on the
 * digests. */
#include "measured_support.h"
#include "measured/merl_known.h"
#include "measured/sha256.h"

/* FIPS 180-2, appendix B, and 'a' repeated around the ends of a block (computed with coreutils). */
static void digests_are_the_published_ones(void **state)
{
    static const struct {
        const char *text;
        int repeated;
        const char *digest;
    } vectors[] = {
        {"", 1, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
        {"abc", 1, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
        {"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", 1,
         "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"},
        {"a", 1000000, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"},
        {"a", 55, "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318"},
        {"a", 56, "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a"},
        {"a", 63, "7d3e74a05d7db15bce4ad9ec0658ea98e3f06eeecf16b4c6fff2da457ddc2f34"},
        {"a", 64, "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb"},
        {"a", 119, "31eba51c313a5c08226adf18d4a359cfdfd8d2e816b13f4af952f7ea6584dcfb"},
        {"a", 120, "2f3d335432c70b580af0e8e1b3674a7c020d683aa5f73aaaedfdc55af904c21c"}};
    (void)state;
    for (size_t i = 0; i < sizeof vectors / sizeof vectors[0]; i++) {
        size_t length = strlen(vectors[i].text), size = length * (size_t)vectors[i].repeated;
        unsigned char *bytes = malloc(size ? size : 1);
        char digest[65];
        assert_non_null(bytes);
        for (size_t k = 0; k < size; k++)
            bytes[k] = (unsigned char)vectors[i].text[k % length];
        hnbrdf_sha256(bytes, size, digest);
        assert_string_equal(digest, vectors[i].digest);
        free(bytes);
    }
}

static void digests_name_their_material(void **state)
{
    (void)state;
    assert_string_equal(hnbrdf_merl_known_digest(
                            "d6506c69e44430bfe8ea676f3950599ca3a6bfb1f46b9906da336d13991bd37d"),
                        "alum-bronze");
    assert_string_equal(hnbrdf_merl_known_digest(
                            "8ca888458aff42b6ebc95329ef1552782e7cb4c2ddc6df060a5afe5ffa58ba8d"),
                        "chrome");
    assert_null(hnbrdf_merl_known_digest(
        "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"));
    assert_null(hnbrdf_merl_known_digest(""));
}

static void a_table_that_only_looks_like_merl_is_not_recognised(void **state)
{
    size_t size = 12 + 24 * 1458000;
    const hnbrdf_measured_options identify = {.merl_identify = 1};
    test_bytes file = {calloc(1, size), size};
    (void)state;
    assert_non_null(file.data);
    put_le(file.data, 90, 4);
    put_le(file.data + 4, 90, 4);
    put_le(file.data + 8, 180, 4);
    hnbrdf_measured *measured = expect_opens_with(file.data, size, "alum-bronze.binary", &identify);
    assert_null(hnbrdf_measured_published(measured));
    hnbrdf_measured_close(measured);
    free(file.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(digests_are_the_published_ones),
        cmocka_unit_test(digests_name_their_material),
        cmocka_unit_test(a_table_that_only_looks_like_merl_is_not_recognised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
