/* Version and status texts: never NULL, and the header's macros are the library's version. How the library was built: the
 * words that the header names, in that order, each with something after its "=", no word a path. */
#include "check.h"

static void check_build(const char *version) {
  static const char *const names[] = {"version", "commit", "target", "profile", "compiler", "kernels", "features"};
  char text[512];
  size_t count = 0;
  CHECK(strlen(stickslip_build()) < sizeof text);
  strcpy(text, stickslip_build());
  CHECK(strchr(text, '/') == NULL && strchr(text, '\\') == NULL && strstr(text, "  ") == NULL);
  for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " "), ++count) {
    char *value = strchr(word, '=');
    CHECK(value != NULL && value[1] != '\0' && count < sizeof names / sizeof *names);
    *value++ = '\0';
    CHECK(strcmp(word, names[count]) == 0);
    if (count == 0) CHECK(strcmp(value, version) == 0);
    if (count == 3) CHECK(strncmp(value, "release-O", 9) == 0 || strncmp(value, "debug-O", 7) == 0);
    if (count == 5) CHECK(strcmp(value, "plain") == 0 || strcmp(value, "avx2+fma") == 0);
  }
  CHECK(count == sizeof names / sizeof *names);
  CHECK(stickslip_build() == stickslip_build());
}

int main(void) {
  char version[32];
  sprintf(version, "%d.%d.%d", STICKSLIP_VERSION_MAJOR, STICKSLIP_VERSION_MINOR, STICKSLIP_VERSION_PATCH);
  CHECK(strcmp(version, stickslip_version()) == 0);
  check_build(version);

  /* Nothing refused yet on this thread. */
  CHECK(stickslip_last_error_message() != NULL && stickslip_last_error_message()[0] == '\0');

  for (int32_t status = STICKSLIP_PANIC; status <= STICKSLIP_CONTACT_LOST; ++status) {
    CHECK(strlen(stickslip_status_string(status)) > 3);
    CHECK(strcmp(stickslip_status_string(status), "unknown status") != 0);
    for (int32_t other = STICKSLIP_PANIC; other < status; ++other) {
      CHECK(strcmp(stickslip_status_string(status), stickslip_status_string(other)) != 0);
    }
  }
  CHECK(strcmp(stickslip_status_string(INT32_MIN), "unknown status") == 0);
  CHECK(strcmp(stickslip_status_string(STICKSLIP_CONTACT_LOST + 1), "unknown status") == 0);

  /* A refusal leaves a message, a success clears it. */
  double sum[3] = {0.0, 0.0, 2.0}, normal[3];
  CHECK_REFUSED(stickslip_node_normal(NULL, normal), STICKSLIP_NULL_POINTER, "sum");

  /* The same for a fixed-length variable: padded, cut, empty; the message stays. */
  char fixed[41], expected[41];
  sprintf(expected, "%-40s", stickslip_last_error_message());
  FILL(fixed);
  CHECK(stickslip_last_error_padded(fixed, 40) == STICKSLIP_OK && memcmp(fixed, expected, 40) == 0 && fixed[40] == 0x5A);
  FILL(fixed);
  CHECK(stickslip_last_error_padded(fixed, 3) == STICKSLIP_OK && memcmp(fixed, "sum", 3) == 0 && fixed[3] == 0x5A);
  CHECK(stickslip_last_error_padded(fixed, 0) == STICKSLIP_OK && memcmp(fixed, "sum", 3) == 0);
  CHECK(strncmp(expected, stickslip_last_error_message(), strlen(stickslip_last_error_message())) == 0);
  FILL(fixed);
  CHECK_REFUSED(stickslip_last_error_padded(NULL, 3), STICKSLIP_NULL_POINTER, "text");
  CHECK_REFUSED(stickslip_last_error_padded(fixed, -1), STICKSLIP_INVALID_SIZE, "length");
  CHECK_UNTOUCHED(fixed);
  CHECK_OK(stickslip_node_normal(sum, normal));
  CHECK(normal[0] == 0.0 && normal[1] == 0.0 && normal[2] == -1.0);
  return 0;
}
