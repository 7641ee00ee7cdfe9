"""What ends a body on its far side, a module for each kind of driver: what it sends, sends back, and does at rest."""
