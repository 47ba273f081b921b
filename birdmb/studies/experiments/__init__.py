"""The program against measurements and independent computations, case by case."""
