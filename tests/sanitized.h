/* sanitized.h: is AddressSanitizer watching? Then a test may do less of the same: what it looks at
 * is in the first few of a thousand equal steps. */
#ifndef HNBRDF_TESTS_SANITIZED_H
#define HNBRDF_TESTS_SANITIZED_H

#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#elif defined(__has_feature)
#define SANITIZED __has_feature(address_sanitizer)
#else
#define SANITIZED 0
#endif

#endif
