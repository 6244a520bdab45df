<story>
<p><emotion name="joy" weight="0.35"/>Zuzana bola najlepšia <gesture name="explain"/>hrnčiarka v tejto doline <break time="200ms"/>a zároveň najnetrpezlivejšia.
Jedného rána prišiel z hradu jazdec a objednal si <gesture name="wonder" weight="0.7"/><emphasis>zlatú</emphasis> čašu.
So zlatom ešte nikdy nepracovala, a tak ju chcela najprv vytočiť z hliny <gesture name="present_right"/>ako vzor pre zlatníka.</p>

<p><gesture name="count_three"/>Tri razy točila čašu narýchlo <break time="250ms"/><emotion name="sadness" weight="0.4"/>a tri razy jej v peci praskla.
Na tretí večer <gesture name="sigh"/>pozametala črepy a chcela kruh predať.</p>

<p><emotion name="surprise" weight="0.35"/>Vtom bolo v izbe také <gesture name="listen"/>ticho, že začula hodiny.
<look at="clock"/><prosody rate="90%">Tikali celý čas, ani rýchlejšie, ani pomalšie než inokedy.</prosody><look at="visitor"/>
<emotion name="joy" weight="0.3"/>Sadla si teda ešte raz a nechala kruh točiť sa <gesture name="hands_folded"/>tak pokojne, ako sa kýve kyvadlo.</p>

<p><emotion name="joy" weight="0.7"/>Štvrtá čaša vyšla z ohňa <gesture name="emphasize"/><emphasis>celá</emphasis> a tenká ako list.
Zlatník z nej urobil odliatok a <point at="cup"/>tam stojí, vo vitríne.
<look at="visitor"/>Jej celkom prvá miska je v <look at="cupboard"/>skrinke <break time="250ms"/>a je taká krivá, aká má prvá miska byť.<look at="visitor"/>
<emotion name="joy" weight="0.4"/>Kto sa ponáhľa, môže <gesture name="invite"/>otvoriť malé dvierka a chvíľu sa na ňu dívať.</p>
</story>
