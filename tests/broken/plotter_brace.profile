slender: 1
travel: "G0 X{x} Y{y}\n"
down: "D\n"
line: "G1 X{x} Y{y} {\n"
up: "U\n"
