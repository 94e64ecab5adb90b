"""A second model of the exact search's problem, for general solvers; shares nothing with ours."""
