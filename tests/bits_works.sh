#!/bin/sh
# tests/bits.sh tells apart: a program and itself are the same, one that leaves a last bit otherwise is found, and one
# that does not run.    tests/bits_works.sh PROGRAM; skipped (77) without h5py
/usr/bin/python3 -c 'import h5py' 2> /dev/null || { echo "no h5py here"; exit 77; }
. "$(dirname "$0")/expect.sh"
scenes="shell_modes shell_simulate_resumed rod_design_resumed drawing_monte_carlo"
# shellcheck disable=SC2086
expect 0 "$here/bits.sh" "$program" "$program" $scenes
[ "$(grep -c ': same, [0-9]* things' out.txt)" = 4 ] || { echo "not four scenes:"; cat out.txt; bad=1; }
expect 0 "$here/bits.sh" --threads 1,2,5 "$program" "$program" shell_design_fields
says "shell_design_fields: same"; says "shell_design_fields, 5 threads: same"

cat > other.sh <<END
#!/bin/sh
"$program" "\$@"
code=\$?
/usr/bin/python3 -c '
import h5py, numpy as np
with h5py.File("a.vtkhdf", "r+") as f:
    x = f["slender/state/x"]
    x[-1, 0] = np.nextafter(x[-1, 0], 1)'
exit \$code
END
printf '#!/bin/sh\nexec "%s" "$@" --set output.gcode=a.gcode\n' "$program" > more.sh
printf '#!/bin/sh\necho cannot; exit 3\n' > none.sh
chmod +x other.sh more.sh none.sh
expect 1 "$here/bits.sh" "$program" ./other.sh shell_modes
says "shell_modes: differs: slender/state/x by [0-9.]*e-1[0-9] of 0.034$"
expect 1 "$here/bits.sh" "$program" ./more.sh drawing_monte_carlo; says "differs: a.gcode is in one only"
expect 1 "$here/bits.sh" "$program" ./none.sh shell_modes; says "no run: cannot"
expect 2 "$here/bits.sh" "$program" "$program" no_such_scene; says "no scene is called so"
exit $bad
