slender: 1
travel: "G0 X{x} Y{y}"
down: D
line: "G1 X{x} Y{y}"
up: U
"sp\need": 3
