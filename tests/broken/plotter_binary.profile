slender: 1
travel: 
