slender: 1
travel: "G0 X{x} Y{y}\n"
down: "M3\n"
line: ""
up: "M5\n"
