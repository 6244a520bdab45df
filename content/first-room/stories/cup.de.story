<story>
<p><emotion name="joy" weight="0.35"/>Zuzana war die beste <gesture name="explain"/>Töpferin dieses Tals, <break time="200ms"/>und die ungeduldigste.
Eines Morgens kam ein Reiter von der Burg herunter und bestellte einen <gesture name="wonder" weight="0.7"/><emphasis>goldenen</emphasis> Becher.
Mit Gold hatte sie noch nie gearbeitet, also wollte sie ihn erst aus Ton drehen, <gesture name="present_right"/>als Muster für den Goldschmied.</p>

<p><gesture name="count_three"/>Dreimal drehte sie den Becher in Eile, <break time="250ms"/><emotion name="sadness" weight="0.4"/>und dreimal zersprang er im Ofen.
Am dritten Abend <gesture name="sigh"/>fegte sie die Scherben zusammen und wollte die Scheibe verkaufen.</p>

<p><emotion name="surprise" weight="0.35"/>Da war es so <gesture name="listen"/>still im Zimmer, dass sie die Uhr hörte.
<look at="clock"/><prosody rate="90%">Die hatte die ganze Zeit getickt, nicht schneller und nicht langsamer als immer.</prosody><look at="visitor"/>
<emotion name="joy" weight="0.3"/>Also setzte sie sich noch einmal hin und ließ die Scheibe <gesture name="hands_folded"/>so ruhig gehen, wie das Pendel schwingt.</p>

<p><emotion name="joy" weight="0.7"/>Der vierte Becher kam <gesture name="emphasize"/><emphasis>heil</emphasis> aus dem Feuer, und dünn wie ein Blatt.
Der Goldschmied nahm einen Abdruck davon, und <point at="cup"/>da steht er, in der Vitrine.
<look at="visitor"/>Ihre allererste Schale steht im <look at="cupboard"/>Schränkchen, <break time="250ms"/>so schief, wie eine erste Schale sein soll.<look at="visitor"/>
<emotion name="joy" weight="0.4"/>Wer es eilig hat, darf die <gesture name="invite"/>kleine Tür öffnen und sie eine Weile ansehen.</p>
</story>
