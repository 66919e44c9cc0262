/* sha256.h: SHA-256 (FIPS 180-4), to tell whether a file is a published one. */
#ifndef HNBRDF_MEASURED_SHA256_H
#define HNBRDF_MEASURED_SHA256_H

#include <stddef.h>

/* 64 lower-case hexadecimal digits and a NUL. */
void hnbrdf_sha256(const unsigned char *bytes, size_t size, char digest[65]);

#endif
