#pragma once
/// The macro that public names are declared with. All other names are hidden in a shared library,
/// since the modules are compiled with -fvisibility=hidden. Static libraries use the same macro, so
/// that both kinds are made of the same objects.

/// Makes a class, function or variable visible outside of its library.
#define PALPATE_EXPORT __attribute__((visibility("default")))
