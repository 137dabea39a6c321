#!/bin/sh
# A report in a browser: what is seen of it, and how it is used.    tests/report_browser.sh PROGRAM; skipped (77) without
# Chromium or h5py
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || { echo "no Chromium here"; exit 77; }
/usr/bin/python3 -c 'import h5py' 2> /dev/null || { echo "no h5py here"; exit 77; }
. "$(dirname "$0")/expect.sh"

cat > sheet.yaml <<'END_OF_SCENE'
slender: 1
job: simulate
shell:
  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [8, 4]}
  thickness: 1 mm
  young: {formula: "x < 0.02 ? 1e5 : 3e5"}
  poisson: 0.3
  density: 1000
  magnetization: [1.0e+4, 0, 0]
  gravity: [0, 0, -9.81]
fix: [{group: root, clamp: true}]
time: {step: 4 ms, steps: 10}
END_OF_SCENE
expect 0 "$program" run sheet.yaml --no-picture --quiet
expect 0 "$program" run "$here/scene_rod_simulate.yaml" --no-picture --quiet -o rod --set time.steps=30
expect 0 "$program" run "$here/scene_draw.yaml" --no-picture --quiet -o drawing --set spline.rounds=0 --set output.film=20
sed 's/"x < 0.02 .*"/"10^(4 + 150*x)"/; s/gravity: .*/gravity: [0, 0, 0]/' sheet.yaml > stiff.yaml
expect 0 "$program" run stiff.yaml --no-picture --quiet --set time.steps=1
sed '/^time:/d; /gravity:/d; s/simulate/equilibrium/' sheet.yaml > stages.yaml
cat >> stages.yaml <<'END_OF_SCENE'
probes: {tip: {group: tip}}
sequence: {flux_density: {from: [0, 0, 0], to: [0, 0, 2 mT], count: 3}}
END_OF_SCENE
expect 0 "$program" run stages.yaml --no-picture --quiet
sed '/^time:/d' sheet.yaml > magnet.yaml
cat >> magnet.yaml <<'END_OF_SCENE'
time: {step: 4 ms, steps: 2}
flux_density: {magnet: {at: [20 mm, 10 mm, 30 mm], size: [8 mm, 8 mm, 8 mm], remanence: [0, 0, 1.2]}}
END_OF_SCENE
expect 0 "$program" run magnet.yaml --no-picture --quiet
expect 0 "$program" run "$here/scene_small.yaml" --no-picture --quiet -o design --set design.iterations=8 --set shell.mesh.n=2 --set output.every=2
for name in sheet stiff rod drawing stages magnet design; do expect 0 "$program" report $name.vtkhdf; done
expect 0 "$program" report sheet.vtkhdf rod.vtkhdf -o two.html
expect 0 "$program" report sheet.vtkhdf stages.vtkhdf -o mixed.html
mkdir soft thick
for name in soft thick; do
    expect 0 "$program" run sheet.yaml --no-picture --quiet -o $name/0001 --set time.steps=1 --set "shell.thickness=$([ $name = soft ] && echo 1 || echo 2) mm"
done
expect 0 "$program" report soft/0001.vtkhdf thick/0001.vtkhdf -o pair.html
[ $bad = 0 ] || exit 1
mkdir profile
PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$here/report_browser.py" "$chromium" "$work"
