#pragma once
/// What public names are declared with. All other names are hidden in a shared library, since the
/// modules are compiled with -fvisibility=hidden. It is the same for static libraries, so that both
/// are made of the same objects.

#define PALPATE_EXPORT __attribute__((visibility("default")))
