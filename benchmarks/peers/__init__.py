"""The thesis's genetic algorithm, written with DEAP, pymoo and PyGAD."""
