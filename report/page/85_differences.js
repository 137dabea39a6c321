/* What distinguishes results of one scene, as those of a sweep: values of their scenes' texts. */

/* Each single value by its path: "shell.young" -> "100000". */
function sceneValues(text) {
  const values = new Map(), items = new Map(), stack = [];
  for (const line of text.split("\n")) {
    const found = /^( *)(?:(-)|"?([^":]+)"?: *(.*))$/.exec(line);
    if (!found) continue;
    const [, space, dash, key, value] = found;
    while (stack.length && stack[stack.length - 1].depth >= space.length) stack.pop();
    const parent = stack.map((one) => one.name).join(".");
    if (dash) items.set(parent, (items.has(parent) ? items.get(parent) : -1) + 1);
    stack.push({ depth: space.length, name: dash ? items.get(parent) : key });
    if (value) values.set(stack.map((one) => one.name).join(".").replace(/\.value$/, ""), value);
  }
  return values;
}

/* [result] its [path, value] that others have not; none of scenes that are more different than that. */
function differencesOf(results) {
  const MOST = 8, all = results.map((result) => sceneValues(result.scene || ""));
  const paths = [...new Set(all.flatMap((values) => [...values.keys()]))].filter((path) => all.some((values) => values.get(path) !== all[0].get(path)));
  return all.map((values) => (paths.length <= MOST ? paths.map((path) => [path, values.has(path) ? values.get(path) : "\u2013"]) : []));
}
