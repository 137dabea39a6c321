#!/bin/sh
# The library as others find it: what it shows, what it needs, and programs linked with it by pkg-config and by CMake.
#   tests/library.sh SOURCE BUILD
source=$(cd "$1" && pwd) build=$2
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
bad=0
complain() { echo "$*"; bad=1; }

# What can be seen of it is what the header says.
declared=$(sed -n 's/^SLENDER_API.*\b\(slender_[a-z0-9_]*\)(.*/\1/p' "$source/include/slender.h" | sort)
shared=$(nm -D --defined-only "$build/libslender.so" | grep -v ' A SLENDER_1$' | sed 's/.* //' | sort)
archive=$(nm -g --defined-only "$build/libslender.a" | grep ' . ' | sed 's/.* //' | sort)
[ "$shared" = "$(echo "$declared" | sed 's/$/@@SLENDER_1/')" ] || complain "the shared library shows: $shared"
[ "$archive" = "$declared" ] || complain "the archive shows: $archive"

# What it needs is there, and nothing of pictures is.
lacks=$(ldd -r "$build/libslender.so" | grep -E 'undefined|not found')
[ -z "$lacks" ] || complain "$lacks"
! readelf -d "$build/libslender.so" | grep -q 'NEEDED.*webp' || complain "the library needs libwebp"

cmake --install "$build" --prefix "$scratch/usr" > "$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
libs=$(dirname "$(find "$scratch/usr" -name libslender.a)")
export PKG_CONFIG_PATH="$libs/pkgconfig" LD_LIBRARY_PATH="$libs"
[ -x "$scratch/usr/bin/slender" ] || complain "the program is not installed"

runs() { # how, command that makes $scratch/consumer
    how=$1
    shift
    rm -f "$scratch/consumer"
    "$@" > "$scratch/log" 2>&1 || { cat "$scratch/log"; complain "$how: cannot be linked"; return; }
    OPENBLAS_NUM_THREADS=1 "$scratch/consumer" > "$scratch/log" 2>&1 || { cat "$scratch/log"; complain "$how: does not run"; }
}
static=$(pkg-config --static --libs slender | sed 's/-lslender/-l:libslender.a/')
for compiler in "cc -x c $source/examples/tutorial.c" "c++ -x c++ $source/tests/consumer.c"; do
    command -v "${compiler%% *}" > /dev/null || continue
    compile="$compiler -Wall -Wextra -Werror -pedantic -x none -o $scratch/consumer $(pkg-config --cflags slender)"
    # shellcheck disable=SC2046,SC2086
    runs "pkg-config, $compiler" $compile $(pkg-config --libs slender) -lm
    # shellcheck disable=SC2086
    runs "pkg-config --static, $compiler" $compile $static -lm
    ! ldd "$scratch/consumer" | grep libslender || complain "the archive was not taken"
done

# Where OpenBLAS cannot have the memory that it works in, it asks for it without end: the call must not come to that.
cc -I"$scratch/usr/include" "$source/examples/tutorial.c" -o "$scratch/tutorial" -L"$libs" -lslender -lm
(ulimit -v 150000; OPENBLAS_NUM_THREADS=1 timeout 60 "$scratch/tutorial" > "$scratch/log" 2>&1)
[ $? = 1 ] && grep -q 'out of memory' "$scratch/log" || { cat "$scratch/log"; complain "without memory: no error"; }

cat > "$scratch/CMakeLists.txt" << END
cmake_minimum_required(VERSION 3.22)
project(consumer LANGUAGES C)
find_package(slender $("$scratch/usr/bin/slender" --version | sed -n 's/^slender //p') REQUIRED)
add_executable(consumer $source/examples/tutorial.c)
target_link_libraries(consumer slender::\${KIND} m)
set_target_properties(consumer PROPERTIES RUNTIME_OUTPUT_DIRECTORY $scratch)
END
by_cmake() { cmake -S "$scratch" -B "$scratch/$1" -DKIND="$1" -DCMAKE_PREFIX_PATH="$scratch/usr" && cmake --build "$scratch/$1"; }
runs "CMake, shared" by_cmake slender
runs "CMake, static" by_cmake slender_static
exit $bad
