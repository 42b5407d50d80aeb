/* Faults put into a running program by LD_PRELOAD.
 *
 *   FAULT_FULL=TEXT    files opened for writing whose path contains TEXT take no byte: ENOSPC, as on a full disk
 *   FAULT_SUBMIT=FILE  in the process that finds FILE, which it removes: the submission of work to the device that
 *                      FAULT_AFTER counts down to fails as FAULT_HOW says: lost (and all later ones too), abort or loop
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int is_full(const char* path) {
  const char* text = getenv("FAULT_FULL");
  return text && *text && strstr(path, text) != NULL;
}

/* Whatever is written to `fd` from now on is refused. */
static void fill(int fd) {
  static int (*real)(const char*, int, ...);
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "open");
  const int full = real("/dev/full", O_RDWR | O_CLOEXEC);
  if (full >= 0) dup2(full, fd), close(full);
}

#define OPEN(name)                                                      \
  int name(const char* path, int flags, ...) {                          \
    static int (*real)(const char*, int, ...);                          \
    if (!real) *(void**)&real = dlsym(RTLD_NEXT, #name);                \
    va_list more;                                                       \
    va_start(more, flags);                                              \
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0; \
    va_end(more);                                                       \
    const int fd = real(path, flags, mode);                             \
    if (fd >= 0 && (flags & O_ACCMODE) != O_RDONLY && is_full(path)) fill(fd); \
    return fd;                                                          \
  }
OPEN(open)
OPEN(open64)

#define FOPEN(name)                                                     \
  FILE* name(const char* path, const char* mode) {                      \
    static FILE* (*real)(const char*, const char*);                     \
    if (!real) *(void**)&real = dlsym(RTLD_NEXT, #name);                \
    FILE* file = real(path, mode);                                      \
    if (file && strpbrk(mode, "wa+") && is_full(path)) fill(fileno(file)); \
    return file;                                                        \
  }
FOPEN(fopen)
FOPEN(fopen64)

enum { device_lost = -4 }; /* VK_ERROR_DEVICE_LOST */

int vkQueueSubmit(void* queue, unsigned count, const void* submits, void* fence) {
  static int (*real)(void*, unsigned, const void*, void*);
  static int left = -1, lost = 0;
  if (!real) {
    *(void**)&real = dlsym(RTLD_NEXT, "vkQueueSubmit");
    const char* file = getenv("FAULT_SUBMIT");
    if (file && unlink(file) == 0) left = atoi(getenv("FAULT_AFTER"));
  }
  if (lost) return device_lost;
  if (left >= 0 && left-- == 0) {
    const char* how = getenv("FAULT_HOW");
    fprintf(stderr, "the fault is here: %s\n", how);
    if (strcmp(how, "abort") == 0) abort();
    if (strcmp(how, "loop") == 0)
      for (volatile int i = 0;; i = i + 1) {
      }
    lost = 1;
    return device_lost;
  }
  return real(queue, count, submits, fence);
}
